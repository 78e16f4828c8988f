#include "tffd/body_volume.hpp"

#include <gtest/gtest.h>

#include <random>

#include "../peak_memory.hpp"
#include "geometry/status.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points nodes_of(const Points& outer, const Points& inner) {
  Points nodes = outer;
  nodes.insert(nodes.end(), inner.begin(), inner.end());
  return nodes;
}

geometry::ControlMesh named_patch(const std::string& name) {
  geometry::ControlMesh control = patch();
  control.regions = {{name, {}}};
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t)
    control.regions[0].triangles.push_back(t);
  return control;
}

void shift(geometry::ControlMesh& control, const Eigen::Vector3d& by) {
  for (Points* nodes : {&control.outer, &control.inner})
    for (Eigen::Vector3d& p : *nodes) p += by;
}

// Two slabs of skin side by side, a patch on each.
struct Pair {
  geometry::TriangleMesh body = slab(41);
  geometry::ControlMesh control;

  Pair() {
    const Eigen::Vector3d aside(0, 0.5, 0);
    const geometry::TriangleMesh one = body;
    const int count = static_cast<int>(one.vertices.size());
    for (const Eigen::Vector3d& p : one.vertices) body.vertices.push_back(p + aside);
    for (const Eigen::Vector3i& t : one.triangles)
      body.triangles.push_back(t + Eigen::Vector3i::Constant(count));
    geometry::ControlMesh other = named_patch("hips");
    shift(other, aside);
    control = geometry::joined({named_patch("bust"), other});
  }
};

TEST(BodyVolume, IsThatOfTheDeformedBody) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = named_patch("bust");
  const Binding binding(body, control, {});
  const auto triangles = carried_triangles(binding, body.triangles, control).at(0);
  ASSERT_GT(triangles.size(), 1000U);
  const Eigen::Vector3d apex(0.01, -0.02, -0.1);
  const BodyVolume volume(binding, triangles, apex);
  const Moved moved = squeezed(control, 0.03);
  const Points after = binding.deform(moved.outer, moved.inner);
  const double before_expected = geometry::cone_volume(body.vertices, triangles, apex),
               after_expected = geometry::cone_volume(after, triangles, apex);
  ASSERT_GT(std::abs(after_expected / before_expected - 1), 0.01);
  // Sums of some thousand terms in another order.
  EXPECT_NEAR(volume.at_rest() / before_expected, 1, 1e-12);
  EXPECT_NEAR(volume(nodes_of(control.outer, control.inner), nullptr) / before_expected, 1, 1e-12);
  EXPECT_NEAR(volume(nodes_of(moved.outer, moved.inner), nullptr) / after_expected, 1, 1e-12);
  Points gradient;
  EXPECT_NEAR(volume(nodes_of(moved.outer, moved.inner), &gradient) / after_expected, 1, 1e-12);
}

TEST(BodyVolume, GoesWithAPosture) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = named_patch("bust");
  const Binding binding(body, control, {});
  const auto triangles = carried_triangles(binding, body.triangles, control).at(0);
  const Eigen::Vector3d apex(0.01, -0.02, -0.1);
  geometry::Spine spine;  // bends where the patch is
  spine.x = -0.5;
  spine.pelvis = -0.3;
  spine.chest = 0.3;
  const geometry::BoneFrames bones(spine, {0.4, -0.2});
  const BodyVolume at_rest(binding, triangles, apex);
  for (const double share : {0.5, 1.0}) {
    const auto posed = [&](Points points) {
      for (Eigen::Vector3d& p : points) p = bones.moved(p, share);
      return points;
    };
    const Points nodes = nodes_of(posed(control.outer), posed(control.inner));
    const double expected = geometry::cone_volume(posed(body.vertices), triangles, bones.moved(apex, share));
    EXPECT_NEAR(at_rest.posed(bones, share)(nodes, nullptr) / expected, 1, 1e-12);
  }
  const Moved moved = squeezed(control, 0.03);
  const Points nodes = nodes_of(moved.outer, moved.inner);
  EXPECT_EQ(at_rest.posed(bones, 0)(nodes, nullptr), at_rest(nodes, nullptr));
}

TEST(BodyVolume, GradientIsThatOfACubic) {
  const geometry::TriangleMesh body = slab(41);
  const geometry::ControlMesh control = named_patch("bust");
  const Binding binding(body, control, {});
  const BodyVolume volume(binding, carried_triangles(binding, body.triangles, control).at(0), {0, 0, -0.1});
  const Moved moved = squeezed(control, 0.02);
  const Points nodes = nodes_of(moved.outer, moved.inner);
  Points gradient(3);  // whatever was in it is gone
  volume(nodes, &gradient);
  ASSERT_EQ(gradient.size(), nodes.size());

  // Along any direction a cubic has central differences that are off by exactly its third derivative's part,
  // h^2; two steps cancel that, so only rounding is left.
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 0.01);
  for (int trial = 0; trial < 10; ++trial) {
    Points direction(nodes.size());
    double slope = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      direction[i] = Eigen::Vector3d(normal(random), normal(random), normal(random));
      slope += gradient[i].dot(direction[i]);
    }
    const auto difference = [&](double h) {
      Points ahead = nodes, behind = nodes;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        ahead[i] += h * direction[i], behind[i] -= h * direction[i];
      return (volume(ahead, nullptr) - volume(behind, nullptr)) / (2 * h);
    };
    EXPECT_NEAR((4 * difference(0.5) - difference(1)) / 3, slope,
                1e-11 * std::abs(volume.at_rest()) + 1e-10 * std::abs(slope))
        << "seed 11, trial " << trial;
  }
}

TEST(BodyVolume, RegionsOfAPairOfPatchesDoNotShareTriangles) {
  const Pair pair;
  const Binding binding(pair.body, pair.control, {});
  const auto carried = carried_triangles(binding, pair.body.triangles, pair.control);
  ASSERT_EQ(carried.size(), 2U);
  const int half = static_cast<int>(pair.body.vertices.size()) / 2;
  ASSERT_EQ(carried[0].size(), carried[1].size());
  for (const Eigen::Vector3i& t : carried[0]) EXPECT_LT(t.maxCoeff(), half);
  for (const Eigen::Vector3i& t : carried[1]) EXPECT_GE(t.minCoeff(), half);

  const BodyVolume bust(binding, carried[0], {0, 0, -0.1}), hips(binding, carried[1], {0, 0.5, -0.1});
  EXPECT_NEAR(bust.at_rest(), hips.at_rest(), 1e-15);
  Points outer = pair.control.outer;
  outer.back() += Eigen::Vector3d(0, 0, 0.01);  // on the rim: carries less, and is enough to see it
  for (std::size_t i = outer.size() / 2; i < outer.size(); ++i) outer[i].z() += 0.01;
  Points gradient;
  EXPECT_EQ(bust(nodes_of(outer, pair.control.inner), &gradient),
            bust(nodes_of(pair.control.outer, pair.control.inner), &gradient));
  EXPECT_GT(hips(nodes_of(outer, pair.control.inner), nullptr), 1.05 * hips.at_rest());
  for (std::size_t i = outer.size() / 2; i < outer.size(); ++i) EXPECT_EQ(gradient[i].norm(), 0);
}

TEST(BodyVolume, NodesOutsideAllRegionsCarryNone) {
  geometry::ControlMesh control = named_patch("bust");
  auto& triangles = control.regions[0].triangles;
  triangles.resize(triangles.size() / 2);  // the half with y < 0
  const geometry::TriangleMesh body = slab(61);
  const Binding binding(body, control, {});
  const auto carried = carried_triangles(binding, body.triangles, control).at(0);
  ASSERT_GT(carried.size(), 500U);
  for (const Eigen::Vector3i& t : carried) EXPECT_LT(body.vertices[t[0]].y(), 0.027);  // one row of nodes on

  std::vector<char> in_region(control.outer.size(), 0);
  for (const int t : triangles)
    for (const int node : control.triangles[t]) in_region[node] = 1;
  const Eigen::MatrixXd values = binding.weights().values;
  std::size_t count = 0;
  for (const Eigen::Vector3i& t : body.triangles) {
    double inside = 0, outside = 0;
    for (const int v : t)
      for (Eigen::Index node = 0; node < values.cols(); ++node)
        (in_region[node] ? inside : outside) += values(v, node);
    count += inside > 0 && inside >= outside;
  }
  EXPECT_EQ(carried.size(), count);
}

TEST(BodyVolume, ManyRegionsTakeMemoryByWhatTheyCarry) {
  constexpr std::size_t kMore = 2000;
  geometry::ControlMesh control = patch();
  for (int t = 0; t < static_cast<int>(control.triangles.size()); ++t) control.regions.push_back({"", {t}});
  const geometry::TriangleMesh body = slab(121);
  const Binding binding(body, control, {});
  const auto few = carried_triangles(binding, body.triangles, control);
  control.regions.resize(few.size() + kMore, {"", {0}});
  const gauge::Growth growth;
  const auto many = carried_triangles(binding, body.triangles, control);
  EXPECT_LT(growth.mebibytes(), 250);  // a number for each vertex and region: 700
  ASSERT_EQ(many.size(), few.size() + kMore);
  for (std::size_t r = 0; r < many.size(); ++r) {
    if (r < few.size())
      EXPECT_EQ(many[r], few[r]) << r;
    else
      EXPECT_TRUE(many[r].empty()) << r;  // the first of equals has them
  }
}

TEST(BodyVolume, RefusesByName) {
  const geometry::TriangleMesh body = slab(21);
  const geometry::ControlMesh control = named_patch("bust");
  Options paper;
  paper.setting = Setting::paper;
  EXPECT_THROW(BodyVolume(Binding(body, control, paper), body.triangles, {0, 0, 0}), geometry::Refusal);
  const BodyVolume volume(Binding(body, control, {}), body.triangles, {0, 0, 0});
  EXPECT_THROW(volume(control.outer, nullptr), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::tffd
