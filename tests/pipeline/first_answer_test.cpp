/// Coarse and fine answers to a garment, over real topics.
#include "shapes_on_the_way.hpp"

namespace tensegric_fit::tests {
namespace {

class FirstAnswerTest : public ShapesTest {
 protected:
  static void SetUpTestSuite() {
    ShapesTest::SetUpTestSuite();
    const boost::function<void(const ControlMesh::ConstPtr&)> on_coarse =
        [](const ControlMesh::ConstPtr& coarse) { coarse_ = coarse; };
    const ros::Subscriber latched = ros::NodeHandle().subscribe<ControlMesh>("control/coarse", 1, on_coarse);
    ASSERT_TRUE(wait_for([] { return coarse_ != nullptr; }));
  }

  static void check_fits(const std::vector<FitState>& fits) {
    ASSERT_EQ(fits.size(), 2u);
    const ControlMesh& fine = *client_->controls.back();
    EXPECT_EQ(coarse_->scan_id, fine.scan_id);
    EXPECT_LT(coarse_->triangles.size(), fine.triangles.size());
    for (const FitState& fit : fits) {
      EXPECT_EQ(fit.scan_id, fine.scan_id);
      EXPECT_EQ(fit.outer.size(), fine.outer.size());
    }
    EXPECT_EQ(fits[0].status, FitState::SOLVING);
    EXPECT_NE(fits[0].note.find("control/coarse"), std::string::npos) << fits[0].note;
    EXPECT_EQ(fits[1].status, FitState::CONVERGED);
  }

  static ControlMesh::ConstPtr coarse_;
};

ControlMesh::ConstPtr FirstAnswerTest::coarse_;

TEST_F(FirstAnswerTest, ItIsTheSkinNearWhereItEndsAndTheFineOneFollows) {
  std::vector<FitState> fits;
  const boost::function<void(const FitState::ConstPtr&)> on_fit = [&fits](const FitState::ConstPtr& fit) {
    fits.push_back(*fit);
  };
  const ros::Subscriber every = ros::NodeHandle().subscribe<FitState>("control/deformed", 100, on_fit);
  ASSERT_TRUE(wait_for([&fits] { return !fits.empty(); }));  // what is latched
  fits.clear();
  std::size_t first_skins =
      0;  // not of each: a skin that has not begun when the fine answer comes is left out
  for (const double ratio : {0.95, 0.93, 0.96}) {
    fits.clear();
    shapes_.clear();
    put_on(ratio);
    ASSERT_TRUE(wait_for([this] { return ended(); }));
    listen(0.5);  // for any that come late
    check_fits(fits);
    EXPECT_TRUE(ended());
    ASSERT_LE(shapes_.size(), 2u);
    if (shapes_.size() < 2) continue;
    ++first_skins;
    // On thirteen bodies the two differ by a quarter of the way.
    EXPECT_LT(way(shapes_[0]->vertices, shapes_[1]->vertices), 0.5 * moved(*shapes_[1]));
  }
  EXPECT_GT(first_skins, 0u);
}

TEST_F(FirstAnswerTest, TheNextCustomersIsOfHerOwnMeshes) {
  put_on(0.92);
  const std::string scan_id = client_->fit(booth_scan("b"));
  ASSERT_NE(scan_id, "");
  ASSERT_TRUE(wait_for([this, &scan_id] { return ended() && shapes_.back()->scan_id == scan_id; }));
  bool next = false;
  for (const DeformedMesh::ConstPtr& shape : shapes_) {
    EXPECT_FALSE(next && shape->scan_id != scan_id) << "one of the last customer came after her";
    next = shape->scan_id == scan_id;
  }
  EXPECT_LT(moved(*shapes_.back()), 0.05);
}

TEST_F(FirstAnswerTest, WhoJoinsLateGetsTheFineOneAlone) {
  put_on(0.93);
  ASSERT_TRUE(wait_for([this] { return ended(); }));
  join_late();
  EXPECT_EQ(shapes_.size(), 1u);
  EXPECT_TRUE(ended());
}

}  // namespace
}  // namespace tensegric_fit::tests
