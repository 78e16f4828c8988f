/// What is kept from garment to garment.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "fit/bind_body.hpp"
#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "tensegric/garment_fitter.hpp"
#include "tensegric_bust.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::node {
namespace {

const tensegric::Progress kGoOn = [](const auto&, const auto&, const auto&) { return true; };

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
  GarmentFitter fitter_{FitterOptions(), fit::bind_body};
};

TEST_F(GarmentFitterTest, AStoppedFitIsNoneAndTheNextIsAsIfItHadNotBeen) {
  GarmentFitter undisturbed{FitterOptions(), fit::bind_body};
  for (GarmentFitter* fitter : {&fitter_, &undisturbed})
    ASSERT_TRUE(fitter->fit({control_, nullptr, nullptr}, chest_at(0.95), 0, kGoOn));
  int steps = 0;
  EXPECT_FALSE(fitter_.fit({control_, nullptr, nullptr}, chest_at(0.8), 0,
                           [&steps](const auto&, const auto&, const auto&) { return ++steps < 3; }));
  EXPECT_EQ(steps, 3);  // it stopped there and then
  const auto after = fitter_.fit({control_, nullptr, nullptr}, chest_at(0.94), 0, kGoOn);
  const auto expected = undisturbed.fit({control_, nullptr, nullptr}, chest_at(0.94), 0, kGoOn);
  ASSERT_TRUE(after && expected);
  EXPECT_EQ(after->iterations, expected->iterations);
  EXPECT_EQ(after->outer, expected->outer);  // to the bit
}

TEST_F(GarmentFitterTest, GarmentsAreCheckedAgainstTheNewestModel) {
  GarmentRequest hat = chest_at(0.95), belt = chest_at(0.95);
  hat.garment.regions = {"hat"};
  belt.garment.lines[0].name = "belt";
  EXPECT_EQ(refusal_of(hat), "accepted");  // no model yet to say no
  ASSERT_TRUE(fitter_.fit({control_, nullptr, nullptr}, chest_at(0.95), 0, kGoOn));
  EXPECT_EQ(refusal_of(chest_at(0.9)), "accepted");
  EXPECT_EQ(refusal_of(hat), "bad_garment");
  EXPECT_EQ(refusal_of(belt), "unknown_line");
}

TEST_F(GarmentFitterTest, KeepsTheBodysVolumeWhereItIsAskedTo) {
  const geometry::ControlMesh control = tensegric::bust_mesh();
  const geometry::TriangleMesh skin{control.outer, control.triangles};
  FitterOptions options;
  options.solver.volume = tensegric::KeptVolume::body;
  GarmentFitter fitter(options, fit::bind_body);
  const auto body = boost::make_shared<TriangleMesh>(to_message(ScanTag(), skin, {}));
  const auto solution = fitter.fit({control_, nullptr, body}, chest_at(0.93), 0, kGoOn);
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, tensegric::Status::converged);
  const geometry::TriangleMesh sent = mesh_in(*body);  // float32 on the way
  const auto after = tffd::Binding(sent, control, {}).deform(solution->outer, solution->inner);
  const Eigen::Vector3d apex = geometry::region_apex(control, control.regions[0]);
  EXPECT_NEAR(geometry::cone_volume(after, skin.triangles, apex) /
                  geometry::cone_volume(sent.vertices, skin.triangles, apex),
              1, 1e-9);  // nodes/tensegric/README.md, Exactness
}

TEST_F(GarmentFitterTest, APostureTakesTheBoundNodesAlong) {
  FitterOptions options;
  options.posture.twist = 0.2;
  GarmentFitter fitter(options, fit::bind_body);
  geometry::BodyMeasures measures;
  measures.heights = {{"hip", 0.9, 1, ""}, {"underbust", 1.12, 1, ""}};
  measures.landmarks = {{"crotch", {0, 0, 0.8}, 1, ""}};
  const auto landmarks = boost::make_shared<Landmarks>(to_message(ScanTag(), measures));
  const auto solution = fitter.fit({control_, landmarks, nullptr}, chest_at(0.97), 0, kGoOn);
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, tensegric::Status::converged);
  const geometry::BoneFrames bones(measures, options.posture);
  const geometry::ControlMesh control = tensegric::bust_mesh();
  for (std::size_t v = 0; v < control.inner.size(); ++v)
    EXPECT_LT((solution->inner[v] - bones.moved(control.inner[v])).norm(), 1e-12);
}

}  // namespace
}  // namespace tensegric_fit::node
