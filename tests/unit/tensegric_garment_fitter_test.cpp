/// What is kept from garment to garment.
#include <gtest/gtest.h>

#include "fit/bind_body.hpp"
#include "geometry/status.hpp"
#include "tensegric/coarse_fitter.hpp"
#include "tensegric_bust.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::tensegric {
namespace {

const Progress kGoOn = [](const auto&, const auto&, const auto&) { return true; };

std::optional<Solution> fit(GarmentFitter& fitter, double ratio, const Progress& progress = kGoOn) {
  return fitter.fit(chest(ratio), SolverName::equilibrium, 0, progress);
}

class GarmentFitterTest : public testing::Test {
 protected:
  std::string refusal_of(const Garment& garment) const {
    try {
      fitter_.check(garment, "a");
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  }

  const geometry::ControlMesh control_ = bust_mesh();
  GarmentFitter fitter_{FitterOptions(), fit::bind_body};
};

TEST_F(GarmentFitterTest, AGarmentIsNotCheckedAgainstAnotherBody) {
  Garment belt = chest(0.9);
  belt.lines[0].name = "belt";
  EXPECT_EQ(refusal_of(belt), "accepted");  // there is no body yet
  fitter_.take("a", control_, nullptr, nullptr);
  EXPECT_EQ(refusal_of(belt), "unknown_line");
  EXPECT_NO_THROW(fitter_.check(belt, "b"));
}

TEST_F(GarmentFitterTest, AStoppedFitIsNoneAndTheNextIsAsIfItHadNotBeen) {
  GarmentFitter undisturbed{FitterOptions(), fit::bind_body};
  for (GarmentFitter* fitter : {&fitter_, &undisturbed}) {
    fitter->take("a", control_, nullptr, nullptr);
    ASSERT_TRUE(fit(*fitter, 0.95));
  }
  int steps = 0;
  EXPECT_FALSE(fit(fitter_, 0.8, [&steps](const auto&, const auto&, const auto&) { return ++steps < 3; }));
  EXPECT_EQ(steps, 3);  // it stopped there and then
  const auto after = fit(fitter_, 0.94);
  const auto expected = fit(undisturbed, 0.94);
  ASSERT_TRUE(after && expected);
  EXPECT_EQ(after->iterations, expected->iterations);
  EXPECT_EQ(after->outer, expected->outer);  // to the bit
}

// What was worn on one body is no start on another, though both have the same bones.
TEST_F(GarmentFitterTest, ANewBodyIsFittedAsIfItWereTheFirst) {
  geometry::ControlMesh other = control_;
  for (std::size_t v = 0; v < other.outer.size(); ++v)
    if (!other.outer_fixed[v]) other.outer[v] += 0.1 * (other.outer[v] - other.inner[v]);
  fitter_.take("a", control_, nullptr, nullptr);
  ASSERT_TRUE(fit(fitter_, 0.95));
  fitter_.take("a", other, nullptr, nullptr);
  GarmentFitter fresh{FitterOptions(), fit::bind_body};
  fresh.take("a", other, nullptr, nullptr);
  const auto second = fit(fitter_, 0.94), alone = fit(fresh, 0.94);
  ASSERT_TRUE(second && alone);
  EXPECT_EQ(second->iterations, alone->iterations);
  EXPECT_EQ(second->outer, alone->outer);  // to the bit
}

// Nothing of the body before is answered for the one that was refused.
TEST(CoarseFitterTest, AfterARefusedMeshThereIsNoAnswer) {
  const geometry::ControlMesh coarse = bust_mesh();
  BustShape shape;
  shape.columns *= 2;
  shape.rows *= 2;
  const geometry::ControlMesh fine = bust_mesh(shape);
  CoarseFitter fitter(FitterOptions(), fit::bind_body);
  const auto answer = [&] {
    return fitter.fit(chest(0.95), build_model(fine, {}).newtons(), SolverName::equilibrium, 0,
                      [] { return true; });
  };
  EXPECT_FALSE(answer());
  fitter.take(coarse, fine, nullptr, nullptr);
  const auto first = answer();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->outer.size(), fine.outer.size());
  EXPECT_EQ(first->triangles, 120);
  geometry::ControlMesh flat = coarse;
  flat.inner = flat.outer;
  EXPECT_THROW(fitter.take(flat, fine, nullptr, nullptr), geometry::Refusal);
  EXPECT_FALSE(answer());
  fitter.take(coarse, fine, nullptr, nullptr);
  const auto again = answer();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->outer, first->outer);  // to the bit
}

TEST_F(GarmentFitterTest, GarmentsAreCheckedAgainstTheNewestModel) {
  Garment hat = chest(0.95), belt = chest(0.95);
  hat.regions = {"hat"};
  belt.lines[0].name = "belt";
  EXPECT_EQ(refusal_of(hat), "accepted");  // no model yet to say no
  fitter_.take("a", control_, nullptr, nullptr);
  EXPECT_EQ(refusal_of(chest(0.9)), "accepted");
  EXPECT_EQ(refusal_of(hat), "bad_garment");
  EXPECT_EQ(refusal_of(belt), "unknown_line");
}

TEST_F(GarmentFitterTest, KeepsTheBodysVolumeWhereItIsAskedTo) {
  const geometry::ControlMesh control = bust_mesh();
  const geometry::TriangleMesh skin{control.outer, control.triangles};
  FitterOptions options;
  options.solver.volume = KeptVolume::body;
  GarmentFitter fitter(options, fit::bind_body);
  fitter.take("a", control, nullptr, [&skin] { return skin; });
  EXPECT_NO_THROW(fitter.check(chest(0.93), "a"));
  const auto solution = fit(fitter, 0.93);
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, Status::converged);
  const auto after = tffd::Binding(skin, control, {}).deform(solution->outer, solution->inner);
  const Eigen::Vector3d apex = geometry::region_apex(control, control.regions[0]);
  EXPECT_NEAR(geometry::cone_volume(after, skin.triangles, apex) /
                  geometry::cone_volume(skin.vertices, skin.triangles, apex),
              1, 1e-9);  // nodes/tensegric/README.md, Exactness
}

TEST_F(GarmentFitterTest, APostureTakesTheBoundNodesAlong) {
  FitterOptions options;
  options.posture.twist = 0.2;
  GarmentFitter fitter(options, fit::bind_body);
  geometry::BodyMeasures measures;
  measures.heights = {{"hip", 0.9, 1, ""}, {"underbust", 1.12, 1, ""}};
  measures.landmarks = {{"crotch", {0, 0, 0.8}, 1, ""}};
  fitter.take("a", control_, &measures, nullptr);
  const auto solution = fit(fitter, 0.97);
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->status, Status::converged);
  const geometry::BoneFrames bones(measures, options.posture);
  const geometry::ControlMesh control = bust_mesh();
  for (std::size_t v = 0; v < control.inner.size(); ++v)
    EXPECT_LT((solution->inner[v] - bones.moved(control.inner[v])).norm(), 1e-12);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
