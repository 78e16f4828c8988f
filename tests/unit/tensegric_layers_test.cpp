// Tissue in several layers of units.
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/posture.hpp"
#include "geometry/status.hpp"
#include "tensegric/model.hpp"
#include "tensegric/solver.hpp"
#include "tensegric/unit_prism.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

ModelOptions layered(int layers) {
  ModelOptions options;
  options.layers = layers;
  return options;
}

TEST(Layers, EachIsAWholeLayerOfUnits) {
  const Model model = build_model(bust_mesh(), layered(3));
  EXPECT_EQ(model.nodes(), 4 * 77);
  EXPECT_EQ(model.free_nodes(), 3 * 45);  // within the rim, above the inner ones, which are bound
  EXPECT_EQ(model.units().size(), 3U * 120);
  EXPECT_EQ(model.struts(), 3 * 360);
  EXPECT_EQ(model.tensile_parts(), 4 * 196 + 3 * 77);  // edges of four levels, laterals of three layers
  const Positions rest = model.rest_positions();
  double whole = 0, split = 0;
  for (const auto& u : build_model(bust_mesh(), {}).units())
    whole += unit_volume({rest[u[0]], rest[u[1]], rest[u[2]], rest[u[3]], rest[u[4]], rest[u[5]]});
  for (const auto& u : model.units())
    split += unit_volume({rest[u[0]], rest[u[1]], rest[u[2]], rest[u[3]], rest[u[4]], rest[u[5]]});
  EXPECT_NEAR(split / whole, 1, 1e-12);  // they share faces: nothing is lost or counted twice
}

TEST(Layers, EverySolverLeavesTheUndeformedModelStill) {
  const Model model = build_model(bust_mesh(), layered(3));
  const Positions rest = model.rest_positions();
  for (const SolverName solver : {SolverName::equilibrium, SolverName::adaptive, SolverName::relaxation}) {
    SolverOptions options;
    options.solver = solver;
    const Solution s = solve(model, chest(1), options);
    EXPECT_EQ(s.status, Status::converged);
    ASSERT_EQ(s.between.size(), 2U * 77);
    for (std::size_t i = 0; i < s.between.size(); ++i)
      EXPECT_LE((s.between[i] - rest[2 * 77 + i]).norm(), 1e-9);  // nodes/tensegric/README.md, Exactness
    for (std::size_t i = 0; i < 77; ++i) EXPECT_LE((s.outer[i] - rest[i]).norm(), 1e-9);
  }
}

TEST(Layers, LineVolumeAndSymmetryAreExact) {
  const Model model = build_model(bust_mesh(), layered(3));
  for (const double ratio : {0.97, 0.90}) {
    const Solution s = solve(model, chest(ratio), {});
    EXPECT_EQ(s.status, Status::converged) << s.note;
    EXPECT_LE(s.residual, 1e-8);
    EXPECT_NEAR(s.lines[0].final / s.lines[0].neutral, 1, 1e-6);  // nodes/tensegric/README.md, Exactness
    EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1,
                1e-9);  // nodes/tensegric/README.md, Exactness
    for (const auto* level : {&s.outer, &s.inner, &s.between})
      for (std::size_t first = 0; first < level->size(); first += 77)
        for (int row = 0; row <= 6; ++row)
          for (int column = 0; column <= 10; ++column) {
            const Eigen::Vector3d& p = (*level)[first + 11 * row + column];
            const Eigen::Vector3d& q = (*level)[first + 11 * row + 10 - column];
            EXPECT_LE((p - q.cwiseProduct(Eigen::Vector3d(-1, 1, 1))).norm(),
                      1e-9);  // nodes/tensegric/README.md, Exactness
          }
  }
}

// Thinner layers follow more nearly how tissue shears in depth: each doubling changes the skin less. All with
// one prestress, low enough for every number of layers.
TEST(Layers, MoreOfThemConverge) {
  std::vector<Solution> fits;
  for (const int layers : {1, 2, 4, 8}) {
    ModelOptions options = layered(layers);
    options.prestress = 0.05;
    options.strut_stiffness = 1;
    options.volume_stiffness = 8;
    fits.push_back(solve(build_model(bust_mesh(), options), chest(0.95), {}));
  }
  const auto change = [&fits](int k) {
    double sum = 0;
    for (std::size_t i = 0; i < fits[k].outer.size(); ++i)
      sum += (fits[k].outer[i] - fits[k + 1].outer[i]).squaredNorm();
    return std::sqrt(sum);
  };
  EXPECT_LT(change(1), 0.6 * change(0));
  EXPECT_LT(change(2), 0.6 * change(1));
}

TEST(Layers, AWarmStartKnowsThem) {
  const Model model = build_model(bust_mesh(), layered(2));
  const Solution first = solve(model, chest(0.95), {});
  const Solution warm = solve(model, chest(0.94), {}, &first), cold = solve(model, chest(0.94), {});
  EXPECT_EQ(warm.status, Status::converged);
  EXPECT_LT(warm.iterations, cold.iterations);
  for (std::size_t i = 0; i < warm.outer.size(); ++i)  // both are balanced to 1e-10 of the mean tension
    EXPECT_LE((warm.outer[i] - cold.outer[i]).norm(), 1e-8);
  const Model other = build_model(bust_mesh(), layered(3));
  EXPECT_THROW(solve(other, chest(0.94), {}, &first), geometry::Refusal);
}

TEST(Layers, AsManyAsMakeSense) {
  for (const int layers : {-1, 0, static_cast<int>(kLayers.high) + 1})
    EXPECT_THROW(build_model(bust_mesh(), layered(layers)), geometry::Refusal) << layers;
}

}  // namespace
}  // namespace tensegric_fit::tensegric
