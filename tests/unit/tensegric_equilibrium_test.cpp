// The equilibrium solver on the bust: exactness, symmetry, laws of bands, requests out of reach, bad input.
#include <gtest/gtest.h>

#include <cstring>

#include "geometry/status.hpp"
#include "point_lists.hpp"
#include "tensegric/shape_check.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

Garment elastic_chest(double ratio, const TensionLaw& law) {
  Garment garment = chest(ratio);
  garment.lines[0].law = law;
  return garment;
}

TensionLaw stiffness(double s) {
  TensionLaw law;
  law.kind = TensionLaw::Kind::stiffness;
  law.stiffness = s;
  return law;
}

double farthest_move(const Solution& s, const geometry::ControlMesh& control) {
  return std::max(farthest(s.outer, control.outer), farthest(s.inner, control.inner));
}

// nodes/tensegric/README.md, Exactness.
void expect_exact(const Solution& s) {
  EXPECT_EQ(s.status, Status::converged) << s.note;
  EXPECT_LE(s.residual, 1e-8);
  for (const LineResult& line : s.lines) EXPECT_NEAR(line.final / line.neutral, 1, 1e-6);
  for (const RegionResult& r : s.regions) EXPECT_NEAR(r.volume_after / r.volume_before, 1, 1e-9);
}

class Equilibrium : public testing::Test {
 protected:
  const geometry::ControlMesh control = bust_mesh();
  const Model model = build_model(control, {});
};

TEST_F(Equilibrium, UndeformedModelStaysStill) {
  const Solution s = solve(model, chest(1), {});
  EXPECT_EQ(s.status, Status::converged);
  EXPECT_LE(farthest_move(s, control), 1e-9);
  const Solution slack = solve(model, chest(1.2), {});
  EXPECT_LE(farthest_move(slack, control), 1e-9);
  EXPECT_EQ(slack.lines[0].tension, 0);
}

TEST_F(Equilibrium, LineAndVolumeAreExact) {
  for (double ratio : {0.97, 0.95, 0.90}) {
    const Solution s = solve(model, chest(ratio), {});
    expect_exact(s);
    EXPECT_GT(s.lines[0].tension, 0);
    EXPECT_NEAR(s.lines[0].neutral, ratio * s.lines[0].initial, 1e-12);
    EXPECT_NEAR(s.lines[0].final, line_length(s.lines[0].nodes, s.outer), 1e-12);
    EXPECT_EQ(triangle_change(model,
                              [&s] {
                                Positions x = s.outer;
                                x.insert(x.end(), s.inner.begin(), s.inner.end());
                                return x;
                              }())
                  .turned_over,
              0);
    for (std::size_t i = 0; i < control.outer.size(); ++i)
      EXPECT_TRUE(!control.outer_fixed[i] || s.outer[i] == control.outer[i]);
  }
}

TEST_F(Equilibrium, FinerMeshesAreExactToo) {
  BustShape shape;
  shape.columns *= 2;
  shape.rows *= 2;
  geometry::ControlMesh fine = bust_mesh(shape);
  for (std::size_t i = 0; i < fine.outer.size(); ++i) fine.inner[i] = (fine.inner[i] + fine.outer[i]) / 2;
  expect_exact(solve(build_model(fine, {}), chest(0.90), {}));
}

TEST_F(Equilibrium, WithTheRimFreeInDepth) {
  BustShape shape;
  shape.rim_inner_fixed = false;
  expect_exact(solve(build_model(bust_mesh(shape), {}), chest(0.90), {}));
}

TEST_F(Equilibrium, SymmetricBodyGivesSymmetricResult) {
  for (double ratio : {0.97, 0.90}) {
    const Solution s = solve(model, chest(ratio), {});
    for (int row = 0; row <= 6; ++row) {
      for (int column = 0; column <= 10; ++column) {
        const int i = 11 * row + column, j = 11 * row + 10 - column;
        for (const auto* layer : {&s.outer, &s.inner}) {
          const Eigen::Vector3d& p = (*layer)[i];
          EXPECT_LE((p - (*layer)[j].cwiseProduct(Eigen::Vector3d(-1, 1, 1))).norm(), 1e-9);
        }
      }
    }
  }
}

TEST_F(Equilibrium, WarmStartReachesTheSameBalance) {
  const Solution first = solve(model, chest(0.95), {});
  const Solution warm = solve(model, chest(0.94), {}, &first), cold = solve(model, chest(0.94), {});
  expect_exact(warm);
  EXPECT_LT(warm.iterations, cold.iterations);
  for (std::size_t i = 0; i < control.outer.size(); ++i)  // both are balanced to 1e-10 of the mean tension
    EXPECT_LE((warm.outer[i] - cold.outer[i]).norm(), 1e-8);
  const Solution released = solve(model, chest(1), {}, &first);
  EXPECT_EQ(farthest_move(released, control), 0);
}

// What was worn before leaves no trace: neither in the way back to rest nor in what is handed back early.
TEST_F(Equilibrium, WarmStartAfterAnotherGarment) {
  Garment tips = chest(0.90);
  tips.lines[0].through = {"bust_point_L", "bust_point_R"};
  tips.lines[0].taut = true;
  const Solution before = solve(model, chest(0.90), {}), cold = solve(model, tips, {});
  const Solution warm = solve(model, tips, {}, &before);
  expect_exact(warm);
  for (std::size_t i = 0; i < control.outer.size(); ++i)  // as for any warm start
    EXPECT_LE((warm.outer[i] - cold.outer[i]).norm(), 1e-8);
  int capped = 0;
  for (int most = 1; most < warm.iterations; ++most) {
    SCOPED_TRACE(most);
    SolverOptions options;
    options.max_iterations = most;
    const Solution s = solve(model, tips, options, &before);
    if (s.status == Status::converged) {  // the cap may end the way from the other garment sooner
      expect_exact(s);
      continue;
    }
    EXPECT_EQ(s.status, Status::capped);
    ++capped;
    EXPECT_LE(s.iterations, most);
    EXPECT_LE(s.residual, 1);  // no force above the tissue's own at rest
    EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1, 1e-9);
  }
  EXPECT_GT(capped, 0);
}

TEST_F(Equilibrium, ElasticBandFollowsItsLaw) {
  for (double s : {0.5, 5.0, 500.0}) {
    const Solution solution = solve(model, elastic_chest(0.90, stiffness(s)), {});
    EXPECT_EQ(solution.status, Status::converged) << s;
    const LineResult& line = solution.lines[0];
    EXPECT_GT(line.final, line.neutral);
    EXPECT_LT(line.final, line.initial);
    EXPECT_NEAR(line.tension, s * (line.final / line.neutral - 1), 1e-8 * (1 + line.tension));
    EXPECT_NEAR(solution.regions[0].volume_after / solution.regions[0].volume_before, 1, 1e-9);
  }
  TensionLaw table;
  table.kind = TensionLaw::Kind::table;
  table.table = {{1, 0}, {1.02, 0.1}, {1.2, 3}};
  const Solution solution = solve(model, elastic_chest(0.90, table), {});
  EXPECT_EQ(solution.status, Status::converged);
  const double stretch = solution.lines[0].final / solution.lines[0].neutral;
  ASSERT_GT(stretch, 1.02);
  EXPECT_NEAR(solution.lines[0].tension, 0.1 + 2.9 * (stretch - 1.02) / 0.18, 1e-8);
}

TEST_F(Equilibrium, StopsAtTheTensionLimit) {
  Garment garment = chest(0.90);
  garment.lines[0].tension_limit = 0.1;
  const Solution s = solve(model, garment, {});
  EXPECT_EQ(s.status, Status::infeasible);
  EXPECT_NEAR(s.lines[0].tension, 0.1, 1e-9);
  EXPECT_GT(s.lines[0].final, s.lines[0].neutral);
  EXPECT_LT(s.lines[0].final, s.lines[0].initial);
  EXPECT_LE(s.residual, 1e-8);  // a balance all the same
  EXPECT_NE(s.note.find("chest"), std::string::npos);
}

TEST_F(Equilibrium, RequestBelowTheStraightWayIsInfeasible) {
  const Solution s = solve(model, chest(0.3), {});
  EXPECT_EQ(s.status, Status::infeasible) << s.note;
  EXPECT_TRUE(is_finite(s.outer) && is_finite(s.inner));
  const auto& nodes = s.lines[0].nodes;
  EXPECT_GE(s.lines[0].final, (s.outer[nodes.front()] - s.outer[nodes.back()]).norm());
  EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1, 1e-9);
}

// Between its fixed ends the line is straight from the first: there is no way to shorten it.
TEST(FlatSheet, StraightLineIsInfeasibleAtOnce) {
  geometry::ControlMesh flat = bust_mesh();
  for (std::size_t i = 0; i < flat.outer.size(); ++i) {
    flat.outer[i] = Eigen::Vector3d(0.03 * (i % 11), 0, 0.03 * (i / 11));
    flat.inner[i] = flat.outer[i] + Eigen::Vector3d(0, 0.03, 0);
  }
  const Solution s = solve(build_model(flat, {}), chest(0.95), {});
  EXPECT_EQ(s.status, Status::infeasible) << s.note;
  EXPECT_LE(s.iterations, 3);
  EXPECT_LE(farthest_move(s, flat), 1e-9);
  EXPECT_NEAR(s.lines[0].straight, s.lines[0].initial, 1e-12);
  EXPECT_NEAR(s.regions[0].volume_error, 0, 1e-9) << "of a volume of 0";
}

// The chest line in one, and its halves as lines of their own.
TEST_F(Equilibrium, OfLinesOverTheSameNodesTheTighterOneHolds) {
  Garment garment = chest(0.90);
  for (const char* side : {"_L", "_R"}) {
    GarmentLine half = garment.lines[0];
    half.name = std::string("half") + side;
    half.ratio = 0.95;
    half.through = {std::string("axilla") + side, std::string("bust_point") + side, "sternum"};
    garment.lines.push_back(half);
  }
  const Solution both = solve(model, garment, {}), alone = solve(model, chest(0.90), {});
  EXPECT_EQ(both.status, Status::converged) << both.note;
  EXPECT_NEAR(both.lines[0].final / both.lines[0].neutral, 1, 1e-6);
  for (const int half : {1, 2}) {
    EXPECT_LT(both.lines[half].final, both.lines[half].neutral);
    EXPECT_EQ(both.lines[half].tension, 0);
  }
  for (std::size_t i = 0; i < control.outer.size(); ++i)  // both are balanced to 1e-10 of the mean tension
    EXPECT_LE((both.outer[i] - alone.outer[i]).norm(), 1e-8);

  garment.lines[1].ratio = garment.lines[2].ratio = 0.85;
  const Solution halves = solve(model, garment, {});
  EXPECT_EQ(halves.status, Status::converged) << halves.note;
  EXPECT_EQ(halves.lines[0].tension, 0);
  for (const int half : {1, 2}) EXPECT_NEAR(halves.lines[half].final / halves.lines[half].neutral, 1, 1e-6);
}

TEST_F(Equilibrium, TautLineDrawsTheTipsTogether) {
  Garment garment = chest(0.90);
  garment.lines[0].through = {"bust_point_L", "bust_point_R"};
  garment.lines[0].taut = true;
  const Solution s = solve(model, garment, {});
  expect_exact(s);
  ASSERT_EQ(s.lines[0].nodes.size(), 2U);
  const int left = control.node("bust_point_L"), right = control.node("bust_point_R");
  EXPECT_NEAR((s.outer[left] - s.outer[right]).norm(),
              0.9 * (control.outer[left] - control.outer[right]).norm(), 1e-9);
}

TEST_F(Equilibrium, GravitySags) {
  Garment bare;
  SolverOptions options;
  options.gravity = {0, 0, -0.004};
  const Solution s = solve(model, bare, options);
  EXPECT_EQ(s.status, Status::converged);
  const int tip = control.node("bust_point_L");
  EXPECT_LT(s.outer[tip].z(), control.outer[tip].z() - 1e-4);
  EXPECT_NEAR(s.regions[0].volume_after / s.regions[0].volume_before, 1, 1e-9);
}

TEST_F(Equilibrium, SameInputSameBits) {
  const Solution a = solve(model, chest(0.90), {}), b = solve(build_model(control, {}), chest(0.90), {});
  ASSERT_EQ(a.outer.size(), b.outer.size());
  EXPECT_EQ(std::memcmp(a.outer.data(), b.outer.data(), a.outer.size() * sizeof(a.outer[0])), 0);
  EXPECT_EQ(std::memcmp(a.inner.data(), b.inner.data(), a.inner.size() * sizeof(a.inner[0])), 0);
}

TEST_F(Equilibrium, HistoryAndProgress) {
  SolverOptions options;
  options.track = {control.node("bust_point_L")};
  int calls = 0;
  const auto count = [&calls](const Iterate&, const auto& outer, const auto& inner) {
    ++calls;
    return outer.size() == 77 && inner.size() == 77;
  };
  const Solution s = solve(model, chest(0.95), options, nullptr, count);
  ASSERT_EQ(static_cast<int>(s.history.size()), s.iterations + 1);
  EXPECT_EQ(calls, s.iterations + 1);
  EXPECT_EQ(s.history.front().line_ratios[0], 1);
  EXPECT_NEAR(s.history.back().line_ratios[0], 0.95, 1e-6);
  EXPECT_EQ(s.history.back().tracked[0], s.outer[options.track[0]]);
  const Solution cancelled =
      solve(model, chest(0.95), {}, nullptr, [](const Iterate&, const auto&, const auto&) { return false; });
  EXPECT_EQ(cancelled.status, Status::capped);
  EXPECT_TRUE(is_finite(cancelled.outer) && is_finite(cancelled.inner));
}

TEST_F(Equilibrium, RefusesBadInput) {
  const auto code = [this](const Garment& garment, const SolverOptions& options,
                           const Solution* start = nullptr) {
    try {
      solve(model, garment, options, start);
    } catch (const geometry::Refusal& r) {
      return r.code();
    }
    return std::string("solved");
  };
  Garment unknown = chest(0.95);
  unknown.lines[0].through = {"axilla_L", "elbow", "sternum"};
  EXPECT_EQ(code(unknown, {}), "unknown_line");
  unknown.lines[0].through.clear();
  unknown.lines[0].name = "sash";
  EXPECT_EQ(code(unknown, {}), "unknown_line");
  Garment mirrored = chest(0.95);
  mirrored.lines[0].through = {"axilla_L", "bust_point_L", "sternum"};
  mirrored.lines[0].name = "cup_L";
  EXPECT_EQ(code(mirrored, {}), "solved");
  mirrored.lines[0].name = "cup_R";
  EXPECT_EQ(code(mirrored, {}), "bad_garment");
  Garment hips = chest(0.95);
  hips.regions = {"hips"};
  EXPECT_EQ(code(hips, {}), "bad_garment");
  SolverOptions options;
  options.track = {77};
  EXPECT_EQ(code(chest(0.95), options), "bad_option");
  options = {};
  options.gravity.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(chest(0.95), options), "bad_option");
  const Solution empty;
  EXPECT_EQ(code(chest(0.95), {}, &empty), "bad_option");
  EXPECT_THROW(solver_from("newton"), geometry::Refusal);
  EXPECT_EQ(solver_from("adaptive"), SolverName::adaptive);
}

// P1 Fig. 3: a closed mesh without lines, held at one end.
TEST(ClosedMesh, HangsUnderGravity) {
  geometry::TriangleMesh mesh{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int level = 0; level < 2; ++level) {
    const auto edges = geometry::edges_of(mesh);
    const int count = static_cast<int>(mesh.vertices.size());
    const auto midpoint = [&](int a, int b) {
      const auto at = std::find_if(edges.begin(), edges.end(), [&](const geometry::Edge& e) {
        return e.first == std::min(a, b) && e.second == std::max(a, b);
      });
      return count + static_cast<int>(at - edges.begin());
    };
    for (const geometry::Edge& e : edges)
      mesh.vertices.push_back((mesh.vertices[e.first] + mesh.vertices[e.second]).normalized());
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const int a = midpoint(t[0], t[1]), b = midpoint(t[1], t[2]), c = midpoint(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    mesh.triangles = finer;
  }
  geometry::ControlMesh control;
  const auto normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.vertices[i].cwiseProduct(Eigen::Vector3d(0.3, 0.1, 0.12));
    control.outer.push_back(p);
    control.inner.push_back(0.7 * p);
    control.outer_fixed.push_back(p.x() < -0.2);
    control.inner_fixed.push_back(p.x() < -0.2);
  }
  control.triangles = mesh.triangles;
  control.names.resize(control.outer.size());
  control.regions.push_back({"body", {}});
  for (std::size_t t = 0; t < control.triangles.size(); ++t)
    control.regions[0].triangles.push_back(static_cast<int>(t));

  const Model model = build_model(control, papers_model());
  for (SolverName solver : {SolverName::equilibrium, SolverName::relaxation}) {
    SolverOptions options;
    options.solver = solver;
    options.gravity = {0, 0, -0.001};
    const Solution s = solve(model, {}, options);
    EXPECT_EQ(s.status, Status::converged) << to_string(solver) << " " << s.residual;
    EXPECT_LT(s.outer[0].z(), -0.005);  // the free tip
    EXPECT_NEAR(s.outer[0].y(), 0, 1e-2);
    EXPECT_NEAR(
        s.regions[0].volume_after / s.regions[0].volume_before, 1,
        solver == SolverName::equilibrium ? 1e-9 : 0.05);  // pseudo forces leave a few per cent (P1 §4)
  }
}

}  // namespace
}  // namespace tensegric_fit::tensegric
