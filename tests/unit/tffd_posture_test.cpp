#include <gtest/gtest.h>

#include <cstring>

#include "point_lists.hpp"
#include "tffd/body_volume.hpp"
#include "tffd/distortion.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// A spine along z between the back of the slab and its front; the slab's bump then lies between hip and bust.
geometry::BoneFrames bones(double twist, double side_lean) {
  geometry::Spine spine;
  spine.pelvis = -0.1;
  spine.chest = 0.02;
  return {spine, {twist, side_lean}};
}

TEST(Posed, StillBonesChangeNothing) {
  const geometry::ControlMesh control = patch();
  const Binding binding(slab(61), control, {});
  const Moved moved = squeezed(control, 0.03);
  EXPECT_TRUE(same_bits(binding.posed({}).deform(moved.outer, moved.inner),
                        binding.deform(moved.outer, moved.inner)));
}

TEST(Posed, NodesOnTheBonesCarryTheSkinWithThem) {
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  const geometry::BoneFrames frames = bones(0.3, -0.2);
  const Binding posed = Binding(body, control, {}).posed(frames);
  const auto carried = [&](Points points) {
    for (Eigen::Vector3d& p : points) p = frames.moved(p);
    return points;
  };
  EXPECT_TRUE(
      same_bits(posed.deform(carried(control.outer), carried(control.inner)), carried(body.vertices)));
}

TEST(Posed, ThePapersSettingKeepsTheSkinOnTheBonesToo) {
  const geometry::TriangleMesh body = slab(61);
  Options options;
  options.setting = Setting::paper;
  const geometry::BoneFrames frames = bones(0.3, -0.2);
  const Binding posed = Binding(body, patch(), options).posed(frames);
  const Points deformed = posed.deform(posed.outer(), posed.inner());
  for (std::size_t v = 0; v < deformed.size(); ++v)
    EXPECT_LT((deformed[v] - frames.moved(body.vertices[v])).norm(), 1e-12) << v;  // rounding
}

TEST(Posed, APostureDistortsNothing) {
  const Binding posed = Binding(slab(61), patch(), {}).posed(bones(0, 0.4));
  for (const double value : body_distortion(posed, control_distortion(posed, posed.outer())))
    EXPECT_EQ(value, 1);
}

TEST(Posed, AGarmentTurnsWithTheChest) {
  // All of the slab above the chest: the bones are one rigid motion there, so wearing and turning commute.
  const geometry::TriangleMesh body = slab(61);
  const geometry::ControlMesh control = patch();
  geometry::Spine spine;
  spine.pelvis = -2;
  spine.chest = -1;
  const geometry::BoneFrames frames(spine, {0.3, 0.1});
  const Binding binding(body, control, {});
  const Moved moved = squeezed(control, 0.03);
  const auto carried = [&](Points points) {
    for (Eigen::Vector3d& p : points) p = frames.moved(p);
    return points;
  };
  const Points worn_then_turned = carried(binding.deform(moved.outer, moved.inner)),
               turned_then_worn = binding.posed(frames).deform(carried(moved.outer), carried(moved.inner));
  for (std::size_t v = 0; v < body.vertices.size(); ++v)
    EXPECT_LT((worn_then_turned[v] - turned_then_worn[v]).norm(),
              1e-14);  // rounding of coordinates below 1 m
}

TEST(Posed, VolumeIsThatOfThePosedBody) {
  const geometry::TriangleMesh body = slab(61);
  geometry::ControlMesh control = patch();
  const Binding posed = Binding(body, control, {}).posed(bones(0.3, -0.2));
  const Eigen::Vector3d apex(0, 0, -0.1);
  const BodyVolume volume(posed, body.triangles, apex);
  const double expected = geometry::cone_volume(posed.vertices(), body.triangles, apex);
  Points nodes = posed.outer();
  nodes.insert(nodes.end(), posed.inner().begin(), posed.inner().end());
  EXPECT_NEAR(volume(nodes, nullptr) / expected, 1, 1e-12);
}

}  // namespace
}  // namespace tensegric_fit::tffd
