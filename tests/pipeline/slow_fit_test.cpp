/// A fit that takes its time, over real topics: the skin is seen on its way.
#include "shapes_on_the_way.hpp"

namespace tensegric_fit::tests {
namespace {

class SlowFitTest : public ShapesTest {};

TEST_F(SlowFitTest, TheSkinIsSeenOnItsWayAndTheFitHasTheLastWord) {
  put_on(0.85);
  ASSERT_TRUE(wait_for([this] { return ended(); }));
  listen(1);  // for any that come late
  ASSERT_TRUE(ended());
  EXPECT_EQ(std::count_if(shapes_.begin(), shapes_.end(), on_its_way) + 1,
            static_cast<std::ptrdiff_t>(shapes_.size()));
  const double whole = moved(*shapes_.back());
  EXPECT_GT(whole, 0.005);
  EXPECT_TRUE(std::any_of(
      shapes_.begin(), shapes_.end(),
      [&](const auto& shape) { return moved(*shape) > 0.05 * whole && moved(*shape) < 0.95 * whole; }))
      << shapes_.size() << " shapes came";
}

TEST_F(SlowFitTest, TheNewestGarmentTakesThePlaceOfOneUnderWay) {
  client_->fits.clear();
  put_on(0.85);
  ASSERT_TRUE(wait_for([this] { return under_way(); }));
  put_on(0.97);
  ASSERT_TRUE(wait_for([this] { return ended(); }));
  listen(1);
  ASSERT_EQ(client_->fits.size(), 1u);  // the first was given up
  EXPECT_NEAR(client_->fits.back()->lines.at(0).ratio, 0.97, 1e-4);
  EXPECT_TRUE(ended());
  EXPECT_LT(moved(*shapes_.back()), 0.01);
}

TEST_F(SlowFitTest, TheNextCustomerTakesThePlaceOfOneUnderWay) {
  put_on(0.85);
  ASSERT_TRUE(wait_for([this] { return under_way(); }));
  const std::string scan_id = client_->fit(booth_scan("a"));  // on body b this garment takes half a minute
  ASSERT_NE(scan_id, "");
  listen(1);
  EXPECT_TRUE(ended());
  EXPECT_EQ(shapes_.back()->scan_id, scan_id);
  bool next = false;
  for (const DeformedMesh::ConstPtr& shape : shapes_) {
    EXPECT_FALSE(next && shape->scan_id != scan_id) << "one of the last customer came after her";
    next = shape->scan_id == scan_id;
    for (const TriangleMesh::ConstPtr& body : client_->bodies) {
      if (body->scan_id != shape->scan_id) continue;
      EXPECT_EQ(shape->vertices.size(), body->vertices.size());
    }
  }
}

TEST_F(SlowFitTest, WhoJoinsLateGetsHowItEndedAndNothingOnItsWay) {
  put_on(0.95);
  ASSERT_TRUE(wait_for([this] { return ended(); }));
  ASSERT_TRUE(std::any_of(shapes_.begin(), shapes_.end(), on_its_way));
  join_late();
  EXPECT_EQ(shapes_.size(), 1u);
  EXPECT_TRUE(ended());
}

}  // namespace
}  // namespace tensegric_fit::tests
