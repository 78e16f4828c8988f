/// What is kept from garment to garment.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/garment_fitter.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::node {
namespace {

const tensegric::Progress kGoOn = [](const auto&, const auto&) { return true; };

GarmentRequest chest_at(double ratio) {
  GarmentRequest request;
  request.garment.regions = {"bust"};
  request.garment.lines.resize(1);
  request.garment.lines[0].name = "chest";
  request.garment.lines[0].ratio = ratio;
  return request;
}

class GarmentFitterTest : public testing::Test {
 protected:
  std::string refusal_of(const GarmentRequest& request) const {
    try {
      fitter_.check(request.garment);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  }

  const ControlMesh::ConstPtr control_ =
      boost::make_shared<ControlMesh>(to_message(ScanTag(), tensegric::bust_mesh()));
  GarmentFitter fitter_{FitterOptions()};
};

TEST_F(GarmentFitterTest, AStoppedFitIsNoneAndTheNextIsAsIfItHadNotBeen) {
  GarmentFitter undisturbed{FitterOptions()};
  for (GarmentFitter* fitter : {&fitter_, &undisturbed})
    ASSERT_TRUE(fitter->fit({control_, nullptr, nullptr}, chest_at(0.95), true, kGoOn));
  int steps = 0;
  EXPECT_FALSE(fitter_.fit({control_, nullptr, nullptr}, chest_at(0.8), false,
                           [&steps](const auto&, const auto&) { return ++steps < 3; }));
  EXPECT_EQ(steps, 3);  // it stopped there and then
  const auto after = fitter_.fit({control_, nullptr, nullptr}, chest_at(0.94), false, kGoOn);
  const auto expected = undisturbed.fit({control_, nullptr, nullptr}, chest_at(0.94), false, kGoOn);
  ASSERT_TRUE(after && expected);
  EXPECT_EQ(after->iterations, expected->iterations);
  EXPECT_EQ(after->outer, expected->outer);  // to the bit
}

TEST_F(GarmentFitterTest, GarmentsAreCheckedAgainstTheNewestModel) {
  GarmentRequest hat = chest_at(0.95), belt = chest_at(0.95);
  hat.garment.regions = {"hat"};
  belt.garment.lines[0].name = "belt";
  EXPECT_EQ(refusal_of(hat), "accepted");  // no model yet to say no
  ASSERT_TRUE(fitter_.fit({control_, nullptr, nullptr}, chest_at(0.95), true, kGoOn));
  EXPECT_EQ(refusal_of(chest_at(0.9)), "accepted");
  EXPECT_EQ(refusal_of(hat), "bad_garment");
  EXPECT_EQ(refusal_of(belt), "unknown_line");
}

}  // namespace
}  // namespace tensegric_fit::node
