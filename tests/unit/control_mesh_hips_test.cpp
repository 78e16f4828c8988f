// The hips template: its shape as data, and laid on bodies of the virtual booth.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "control_mesh/fit_template.hpp"
#include "control_mesh/grid.hpp"
#include "control_mesh/skin.hpp"
#include "control_mesh_changed_template.hpp"
#include "control_mesh_templates.hpp"
#include "geometry/status.hpp"
#include "measured_body.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit {
namespace {

using control_mesh::refusal_with;
using Eigen::Vector3d;

struct Body {
  geometry::TriangleMesh mesh;
  geometry::BodyMeasures measures;
};

/// 0 is the booth's own symmetric body; the others are drawn, so that hips, waist, breasts and stance differ.
Body body_of(unsigned seed) {
  virtual_body::BodyParameters parameters;
  if (seed > 0) {
    std::mt19937 random(seed);
    const auto between = [&random](double low, double high) {
      return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    parameters.stature = between(1.50, 1.85);
    parameters.waist = between(0.92, 1.30);
    parameters.hip = between(0.92, 1.20);
    parameters.asymmetry = between(-0.15, 0.15);
    parameters.arm_angle = between(0.45, 0.75);
    parameters.yaw = between(-3, 3);
    parameters.tilt = between(-0.1, 0.1);
  }
  Body body;
  body.mesh = virtual_body::make_body(parameters).mesh;
  body.measures = test::measured(body.mesh);
  return body;
}

/// Landmarks are read by a model that was registered to random samples: symmetric within half a millimetre
/// only.
void make_symmetric(geometry::BodyMeasures& measures, const Vector3d& mirror) {
  measures.body_from_scan.setIdentity();  // the booth's body stands so
  const std::vector<geometry::Landmark> found = measures.landmarks;
  for (geometry::Landmark& landmark : measures.landmarks)
    for (const geometry::Landmark& other : found)
      if (other.name == control_mesh::name_on(landmark.name, control_mesh::Side::right))
        landmark.position = 0.5 * (landmark.position + other.position.cwiseProduct(mirror));
}

geometry::ControlMesh fit(const Body& body, int triangles = 120) {
  control_mesh::Options options;
  options.control_triangles = triangles;
  return control_mesh::fit_template(control_mesh::load_template(kHips), body.mesh, body.measures, options);
}

TEST(HipsTemplate, HasTwoLegsAndNoNodeBetweenThem) {
  const auto pattern = control_mesh::load_template(kHips);
  const auto grid = control_mesh::grid_of(pattern);
  EXPECT_EQ(grid.outer.size(), 103u);
  EXPECT_EQ(grid.triangles.size(), 160u);
  EXPECT_EQ(grid.regions.at(0).name, "hips");
  EXPECT_EQ(grid.regions.at(0).triangles.size(), 160u);
  EXPECT_EQ(control_mesh::node_at(pattern, 5, pattern.middle(), control_mesh::Side::left), -1);
  std::vector<char> used(grid.outer.size(), 0);
  for (const auto& t : grid.triangles)
    for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0) << "a node without triangles";
  // One piece with one rim: V - E + F of a disc.
  const auto edges = geometry::edges_of({grid.outer, grid.triangles});
  EXPECT_EQ(grid.outer.size() + grid.triangles.size() - edges.size(), 1u);
  // Held, but where the cleft ends: there skin goes on between the thighs.
  using control_mesh::Side;
  const std::set<int> free = {control_mesh::node_at(pattern, 4, 6, Side::left),
                              control_mesh::node_at(pattern, 4, 6, Side::right),
                              control_mesh::node_at(pattern, 4, pattern.middle(), Side::left)};
  for (const geometry::Edge& edge : edges) {
    if (edge.right >= 0) continue;
    for (const int node : {edge.first, edge.second})
      EXPECT_NE(grid.outer_fixed[node] != 0, free.count(node) == 1) << node;
  }
}

TEST(HipsTemplate, SharesNoNameWithTheBust) {
  const auto hips = control_mesh::grid_of(control_mesh::load_template(kHips));
  const auto bust = control_mesh::load_template(kTemplates + "bust.yaml");
  const auto bust_grid = control_mesh::grid_of(bust);
  for (const std::string& name : hips.names) {
    if (!name.empty()) {
      EXPECT_EQ(bust_grid.node(name), -1) << name;
    }
  }
  for (const std::string stem :
       {"hip_side", "waist_side", "waist_back", "outer_buttock", "buttock_point", "gluteal_fold"})
    for (const char* side : {"_L", "_R"}) EXPECT_GE(hips.node(stem + side), 0) << stem << side;
  EXPECT_GE(hips.node("centre_back"), 0);
}

class OnBooth : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Bodies, OnBooth, testing::Range(0u, 4u));

TEST_P(OnBooth, LiesOnTheSkinWithoutFoldsAndHoldsWhatIsBelow) {
  const Body body = body_of(GetParam());
  const control_mesh::Skin skin(body.mesh);
  const auto control = fit(body);
  for (std::size_t v = 0; v < control.outer.size(); ++v)
    EXPECT_LE((skin.nearest(control.outer[v]) - control.outer[v]).norm(), 0.003 + 1e-9) << "node " << v;
  for (const auto& t : control.triangles)
    EXPECT_GT(area_of(control.outer, t).dot(area_of(control.inner, t)), 0)
        << "an inner triangle is turned over";
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles})) {
    if (edge.right < 0) continue;
    // the cleft and the fold bend by up to 95 degrees; folded over is 180
    EXPECT_GT(area_of(control.outer, control.triangles[edge.left])
                  .normalized()
                  .dot(area_of(control.outer, control.triangles[edge.right]).normalized()),
              -0.5);
  }

  const auto fine = fit(body, 2000);  // 10 mm wide triangles stand for the skin
  const Vector3d apex = geometry::region_apex(control, control.regions[0]);
  EXPECT_NEAR(geometry::cone_volume(control.outer, control.triangles, apex) /
                  geometry::cone_volume(fine.outer, fine.triangles, apex),
              1, 0.02);
}

TEST(HipsTemplate, SymmetricBodyGivesSymmetricControlMesh) {
  Body body = body_of(0);
  const Vector3d mirror(1, -1, 1);
  make_symmetric(body.measures, mirror);
  const auto control = fit(body);
  for (std::size_t v = 0; v < control.outer.size(); ++v) {
    const Vector3d outer = body.measures.body_from_scan * control.outer[v],
                   inner = body.measures.body_from_scan * control.inner[v];
    double outer_miss = 1, inner_miss = 1;
    for (std::size_t w = 0; w < control.outer.size(); ++w) {
      const double miss =
          (body.measures.body_from_scan * control.outer[w] - outer.cwiseProduct(mirror)).norm();
      if (miss >= outer_miss) continue;
      outer_miss = miss;
      inner_miss = (body.measures.body_from_scan * control.inner[w] - inner.cwiseProduct(mirror)).norm();
    }
    EXPECT_LE(outer_miss, 1e-9) << "node " << v;  // symmetric to 1e-9 m
    EXPECT_LE(inner_miss, 1e-9) << "node " << v;
  }
}

TEST(HipsTemplate, MayNameTheLandmarksThatAreFoundAndNoOthers) {
  const geometry::BodyMeasures measures = body_of(0).measures;
  for (const geometry::Landmark& landmark : measures.landmarks)
    EXPECT_TRUE(geometry::is_landmark(landmark.name)) << landmark.name;
  for (const std::string name : geometry::kLandmarkNames)
    EXPECT_TRUE(measures.find_landmark(name) ||
                std::any_of(measures.missing.begin(), measures.missing.end(),
                            [&name](const geometry::Missing& missing) { return missing.name == name; }))
        << name;
  EXPECT_FALSE(geometry::is_landmark("knee_L"));
}

TEST(HipsTemplate, RefusesWhatDoesNotFit) {
  EXPECT_EQ(refusal_with(kHips, "rows: 7", "rows: 7"), "");
  // A row in two pieces, a character that means nothing, a node where no cell is, ends of columns not placed.
  EXPECT_NE(refusal_with(kHips, "'/////\\/'\n  - '////// '", "'//  /\\/'\n  - '//  // '").find("'diagonals'"),
            std::string::npos);
  EXPECT_NE(refusal_with(kHips, "'/////\\/'", "'/////\\x'").find("'diagonals'"), std::string::npos);
  // Two rows that meet in a corner.
  EXPECT_NE(refusal_with(kHips, "'////// '\n  - '/////\\ '", "'///    '\n  - '   //\\ '").find("'diagonals'"),
            std::string::npos);
  // A hole of one cell, beside which all nodes are there.
  EXPECT_NE(refusal_with(kBust, "'\\\\\\//'", "'\\\\ //'").find("'diagonals'"), std::string::npos);
  EXPECT_NE(refusal_with(kHips, "{row: 4, column: 7,", "{row: 5, column: 7,").find("no cell"),
            std::string::npos);
  EXPECT_NE(refusal_with(
                kHips,
                "{row: 6, column: 6, axis: [hip_side_L, crotch], level: {landmark: gluteal_fold_L, offset: "
                "-0.06}, angle: {landmark: hip_side_L, offset: 125},",
                "{row: 6, column: 6,")
                .find("row 6, column 1"),
            std::string::npos);
  EXPECT_NE(refusal_with(kHips, "axis: [hip_side_L, crotch]", "axis: []").find("'axis'"), std::string::npos);
  EXPECT_NE(
      refusal_with(kHips, "landmark: buttock_L}\n", "landmark: buttock_L, axis: [crotch]}\n").find("'axis'"),
      std::string::npos);
}

}  // namespace
}  // namespace tensegric_fit
