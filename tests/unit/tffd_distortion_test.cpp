#include "tffd/distortion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/status.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points mapped(const Points& points, const Eigen::Matrix3d& map) {
  Points image;
  for (const Eigen::Vector3d& p : points) image.push_back(map * p);
  return image;
}

TEST(Distortion, IsExactlyOneAtRest) {
  const geometry::ControlMesh control = patch();
  const Binding binding(slab(41), control, {});
  const std::vector<double> at_nodes = control_distortion(binding, control.outer);
  for (const double value : at_nodes) EXPECT_EQ(value, 1);
  for (const double value : body_distortion(binding, at_nodes)) EXPECT_EQ(value, 1);
}

TEST(Distortion, OfAScaledPatchIsTheSquare) {
  const geometry::ControlMesh control = patch();
  const Binding binding(slab(21), control, {});
  for (const double scale : {0.5, 0.9, 1.3})
    for (const double value :
         control_distortion(binding, mapped(control.outer, scale * Eigen::Matrix3d::Identity())))
      EXPECT_NEAR(value, scale * scale, 1e-13);
}

TEST(Distortion, OnTheSkinStaysBetweenThatOfTheNodesAndOne) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  const std::vector<double> at_nodes =
      control_distortion(Binding(body, control, {}), squeezed(control, 0.02).outer);
  const auto [least, most] = std::minmax_element(at_nodes.begin(), at_nodes.end());
  ASSERT_LT(*least, 0.95);
  ASSERT_GT(*most, 1.05);
  for (const Setting setting : {Setting::standard, Setting::paper}) {
    Options options;
    options.setting = setting;
    const Binding binding(body, control, options);
    const std::vector<double> on_skin = body_distortion(binding, at_nodes);
    for (int v = 0; v < static_cast<int>(on_skin.size()); ++v) {
      EXPECT_GE(on_skin[v], *least - 1e-12);
      EXPECT_LE(on_skin[v], *most + 1e-12);
      if (!binding.reaches(v)) {
        EXPECT_EQ(on_skin[v], 1);
      }
    }
  }
}

TEST(Distortion, RefusesOtherCounts) {
  const geometry::ControlMesh control = patch();
  const Binding binding(slab(21), control, {});
  EXPECT_THROW(control_distortion(binding, {}), geometry::Refusal);
  EXPECT_THROW(body_distortion(binding, {1.0}), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::tffd
