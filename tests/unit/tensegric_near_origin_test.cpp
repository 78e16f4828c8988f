// A scan far from its frame's origin is solved as near it: every result is that of the same body there,
// moved.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tensegric/near_origin.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// Multiples of what the solver moves by: what it solves is the same to the last bit.
const Vector3d kThere(4000, -1304, 48);
constexpr double kFarRounding = 1e-12;  // m; coordinates of 4 km are 5e-13 apart

/// Coordinates that are the same to the last bit after the way there and back.
std::vector<Vector3d> short_numbers(std::vector<Vector3d> points) {
  for (Vector3d& point : points) point = (point * 0x1p30).array().round() * 0x1p-30;
  return points;
}

geometry::ControlMesh bust() {
  geometry::ControlMesh control = bust_mesh();
  control.outer = short_numbers(control.outer);
  control.inner = short_numbers(control.inner);
  return control;
}

Model model_at(const Vector3d& place) {
  geometry::ControlMesh control = bust();
  for (auto* layer : {&control.outer, &control.inner})
    for (Vector3d& point : *layer) point += place;
  return build_model(control, {});
}

void expect_moved(const std::vector<Vector3d>& near, const std::vector<Vector3d>& far) {
  ASSERT_EQ(near.size(), far.size());
  for (std::size_t i = 0; i < near.size(); ++i)
    EXPECT_LE((near[i] + kThere - far[i]).norm(), kFarRounding) << i;
}

void expect_moved(const Solution& near, const Solution& far) {
  EXPECT_EQ(near.status, far.status);
  EXPECT_EQ(near.iterations, far.iterations);
  EXPECT_EQ(near.residual, far.residual);
  EXPECT_EQ(near.note, far.note);
  expect_moved(near.outer, far.outer);
  expect_moved(near.inner, far.inner);
  expect_moved(near.between, far.between);
  ASSERT_EQ(near.lines.size(), far.lines.size());
  for (std::size_t i = 0; i < near.lines.size(); ++i) {
    const LineResult &a = near.lines[i], &b = far.lines[i];
    EXPECT_EQ(a.final, b.final);
    EXPECT_EQ(a.tension, b.tension);
    EXPECT_EQ(a.pressure, b.pressure);
    expect_moved(a.course_at_rest, b.course_at_rest);
    expect_moved(a.course, b.course);
    ASSERT_EQ(a.fibres.size(), b.fibres.size());
    for (std::size_t f = 0; f < a.fibres.size(); ++f) {
      expect_moved(a.fibres_at_rest[f], b.fibres_at_rest[f]);
      expect_moved(a.fibres[f], b.fibres[f]);
    }
  }
  ASSERT_EQ(near.history.size(), far.history.size());
  for (std::size_t i = 0; i < near.history.size(); ++i)
    expect_moved(near.history[i].tracked, far.history[i].tracked);
}

class FarScan : public testing::Test {
 protected:
  const Model near_ = model_at(Vector3d::Zero()), far_ = model_at(kThere);
};

TEST_F(FarScan, IsMovedThereAndBackToTheLastBit) {
  EXPECT_EQ(offset_to_origin(near_.control), Vector3d(0, 0, -1.25));  // heights of 1.07 to 1.33 m
  EXPECT_EQ(offset_to_origin(far_.control), Vector3d(0, 0, -1.25) - kThere);
  EXPECT_EQ(moved(moved(far_, -kThere), kThere).control.outer, far_.control.outer);
  EXPECT_EQ(moved(far_, -kThere).control.outer, near_.control.outer);
}

TEST(ScanAnywhere, IsMovedThereAndBackToTheLastBit) {
  const unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> decades(-2, 4), signs(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    geometry::ControlMesh control = bust_mesh();
    Vector3d place;
    for (double& at : place) at = std::copysign(std::pow(10, decades(random)), signs(random));
    for (auto* layer : {&control.outer, &control.inner})
      for (Vector3d& point : *layer) point += place;
    const Vector3d by = offset_to_origin(control);
    Model model;
    model.control = control;
    const geometry::ControlMesh there = moved(model, by).control;
    EXPECT_EQ(moved(moved(model, by), -by).control.outer, control.outer);
    EXPECT_EQ(moved(moved(model, by), -by).control.inner, control.inner);
    for (std::size_t n = 1; n < there.outer.size(); ++n)  // differences are exact, too
      EXPECT_EQ(there.outer[n] - there.outer[n - 1], control.outer[n] - control.outer[n - 1]);
    for (const Vector3d& point : there.outer) EXPECT_LT(point.cwiseAbs().maxCoeff(), 1);
  }
}

TEST_F(FarScan, TheFitIsTheOneNearTheOrigin) {
  for (const SolverName solver : {SolverName::equilibrium, SolverName::adaptive, SolverName::relaxation})
    for (const double ratio : {0.95, 0.70}) {
      SolverOptions options;
      options.solver = solver;
      options.max_iterations = 200;
      options.track = {3, 30};
      const Solution near = solve(near_, chest(ratio), options), far = solve(far_, chest(ratio), options);
      expect_moved(near, far);
    }
}

TEST_F(FarScan, AWarmStartIsOneThereToo) {
  const Solution near = solve(near_, chest(0.95), {}), far = solve(far_, chest(0.95), {});
  const Solution here = solve(near_, chest(0.94), {}, &near), there = solve(far_, chest(0.94), {}, &far);
  EXPECT_EQ(there.status, Status::converged);
  EXPECT_EQ(here.iterations, there.iterations);
  EXPECT_LT(there.iterations, solve(far_, chest(0.94), {}).iterations);
  ASSERT_EQ(here.outer.size(), there.outer.size());
  for (std::size_t i = 0; i < here.outer.size(); ++i)  // balances to 1e-10 of the mean tension
    EXPECT_LE((here.outer[i] + kThere - there.outer[i]).norm(), 1e-8);
}

TEST_F(FarScan, AnyPlaceWillDo) {
  const Solution near = solve(near_, chest(0.9), {});
  for (const Vector3d& place : {Vector3d(4000.1, -1303.87, 48.3), Vector3d(0.31, -0.77, -1.06)}) {
    const Solution s = solve(model_at(place), chest(0.9), {});
    EXPECT_EQ(s.status, Status::converged);
    EXPECT_EQ(s.iterations, near.iterations);
    ASSERT_EQ(s.outer.size(), near.outer.size());
    for (std::size_t i = 0; i < s.outer.size(); ++i)
      EXPECT_LE((near.outer[i] + place - s.outer[i]).norm(), 1e-8);
  }
}

TEST_F(FarScan, WhereNothingActsNodesAreTheSameToTheLastBit) {
  const Solution bare = solve(far_, {}, {});
  EXPECT_EQ(bare.outer, far_.control.outer);
  EXPECT_EQ(bare.inner, far_.control.inner);
}

TEST_F(FarScan, LinesOnTheBodyLieWhereTheyLay) {
  const auto laid_on = [](const geometry::ControlMesh& control) {
    geometry::LaidLine laid{"chest", {{1, {}}}};
    for (const int node : control.lines.front().nodes)
      laid.fibres.front().points.push_back({control.outer[node], {{node, 1.0}}});
    return std::vector<geometry::LaidLine>{laid};
  };
  Garment garment = chest(0.95);
  garment.lines.front().points = {Vector3d::Zero(), Vector3d::UnitX()};
  expect_moved(solve(near_, garment, {}, nullptr, {}, {}, laid_on(near_.control)),
               solve(far_, garment, {}, nullptr, {}, {}, laid_on(far_.control)));
}

TEST_F(FarScan, PostureTurnsAboutTheSpine) {
  geometry::Spine spine;
  spine.y = 0.05;
  spine.pelvis = 1.0;
  spine.chest = 1.3;
  SolverOptions near, far;
  near.bones = {spine, {0.3, 0.1}};
  spine.body_from_scan.translate(-kThere);
  far.bones = {spine, {0.3, 0.1}};
  const Solution here = solve(near_, chest(0.95), near), there = solve(far_, chest(0.95), far);
  EXPECT_EQ(here.status, there.status);
  ASSERT_EQ(here.outer.size(), there.outer.size());
  for (std::size_t i = 0; i < here.outer.size(); ++i)  // frames of 4 km round to a few 1e-12 m
    EXPECT_LE((here.outer[i] + kThere - there.outer[i]).norm(), 1e-10);
}

TEST_F(FarScan, WhoIsAskedSeesTheScansFrame) {
  const auto first = [](const Model& model) { return model.control.outer.front(); };  // a fixed node
  const auto solve_and_look = [&](const Model& model, int& asked) {
    const PosedVolume body = [&](double) -> VolumeFunction {
      return [&](const Positions& nodes, Positions* gradient) {
        EXPECT_EQ(nodes.front(), first(model));
        const std::size_t count = model.control.outer.size();
        Positions outer(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(count));
        const Vector3d apex = geometry::region_apex(model.control, model.control.regions[0]);
        if (gradient != nullptr) {
          gradient->assign(2 * count, Vector3d::Zero());
          for (const Eigen::Vector3i& t : model.control.triangles)
            for (int k = 0; k < 3; ++k)
              (*gradient)[t[k]] += (outer[t[(k + 1) % 3]] - apex).cross(outer[t[(k + 2) % 3]] - apex) / 6;
        }
        return geometry::cone_volume(outer, model.control.triangles, apex);
      };
    };
    SolverOptions options;
    options.volume = KeptVolume::body;
    options.track = {0};
    return solve(
        model, chest(0.95), options, nullptr,
        [&](const Iterate& iterate, const std::vector<Vector3d>& outer, const std::vector<Vector3d>&) {
          EXPECT_EQ(outer.front(), first(model));
          EXPECT_EQ(iterate.tracked.front(), first(model));
          return true;
        },
        {body}, {},
        [&](const std::vector<Vector3d>& outer, const std::vector<Vector3d>&) {
          EXPECT_EQ(outer.front(), first(model));
          ++asked;
          return false;
        });
  };
  int asked_near = 0, asked_far = 0;
  const Solution near = solve_and_look(near_, asked_near), far = solve_and_look(far_, asked_far);
  EXPECT_EQ(near.status, Status::converged);
  EXPECT_EQ(far.status, Status::converged);
  EXPECT_LE(std::abs(near.iterations - far.iterations), 2);  // the body's volume rounds by its place
  EXPECT_GT(asked_near, 0);
  EXPECT_GT(asked_far, 0);
  for (std::size_t i = 0; i < near.outer.size(); ++i)  // volumes of 4 km coordinates round to some 1e-12
    EXPECT_LE((near.outer[i] + kThere - far.outer[i]).norm(), 1e-9);
}

TEST_F(FarScan, ACancelledFitEndsThere) {
  const Solution far =
      solve(far_, chest(0.9), {}, nullptr, [](const Iterate&, const auto&, const auto&) { return false; });
  EXPECT_EQ(far.status, Status::capped);
  EXPECT_LE((far.outer.front() - far_.control.outer.front()).norm(), 1);
}

}  // namespace
}  // namespace tensegric_fit::tensegric
