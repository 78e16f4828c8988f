/// Messages of bodies <-> core types.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ros/body_messages.hpp"
#include "ros_messages.hpp"

namespace tensegric_fit::node {
namespace {

TEST(BodyMessages, MeshComesBackAsItWas) {
  const geometry::TriangleMesh mesh = tetrahedron();
  const TriangleMesh message = to_message(some_tag(), mesh, {0, 1, 0, 1});
  EXPECT_EQ(message.scan_id, some_tag().scan_id);
  EXPECT_EQ(message.header.stamp, ros::Time(12, 34));
  const geometry::TriangleMesh back = mesh_in(message);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(filled_in(message), (std::vector<char>{0, 1, 0, 1}));
  ASSERT_EQ(back.vertices.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_LE((back.vertices[i] - mesh.vertices[i]).norm(), 1e-7);  // float32 at 1 m
}

TEST(BodyMessages, BrokenMeshesAreRefusedByName) {
  const TriangleMesh good = to_message(some_tag(), tetrahedron(), {});
  TriangleMesh bad = good;
  bad.vertices.pop_back();
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "bad_mesh");
  bad = good;
  bad.triangles[0] = 4;
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "bad_mesh");
  bad = good;
  bad.triangles[0] = 4000000000u;
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "bad_mesh");
  bad = good;
  bad.vertices[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "non_finite");
  bad.vertices[3] = 1e38f;
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "bad_mesh")
      << "areas of it are beyond all floats; found by fuzzing";
  bad = good;
  bad.filled.pop_back();
  EXPECT_EQ(code_of([&] { filled_in(bad); }), "bad_mesh");
  bad.vertices.clear();
  bad.triangles.clear();
  bad.filled.clear();
  EXPECT_EQ(code_of([&] { mesh_in(bad); }), "bad_mesh") << "nothing; found by fuzzing";
}

TEST(BodyMessages, MeasuresComeBackBitForBit) {
  geometry::BodyMeasures measures;
  measures.body_from_scan.linear() =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  measures.body_from_scan.translation() << 0.1, -1.0 / 3, 2;
  measures.landmarks = {{"navel", {0.1, 0.2, 1.0 / 3}, 0.9, ""}, {"crotch", {0, 0, 0.8}, 0.2, "unseen"}};
  measures.heights = {{"bust", 1.2, 0.8, ""}};
  measures.girths = {{"waist", 0.7, 0.4, "no inner minimum"}};
  measures.missing = {{"neck_front", "no head"}};
  measures.loops = {{"waist", {{0, 0, 1}, {0.1, 0, 1}, {0.1, 0.1, 1}}}};

  const geometry::BodyMeasures back = measures_in(to_message(some_tag(), measures));
  EXPECT_EQ(back.body_from_scan.matrix(), measures.body_from_scan.matrix());
  ASSERT_EQ(back.landmarks.size(), 2u);
  EXPECT_EQ(back.landmarks[0].position, measures.landmarks[0].position);
  EXPECT_EQ(back.landmarks[1].name, "crotch");
  EXPECT_EQ(back.landmarks[1].confidence, 0.2);
  EXPECT_EQ(back.landmarks[1].reason, "unseen");
  EXPECT_EQ(back.heights.at(0).metres, 1.2);
  EXPECT_EQ(back.girths.at(0).reason, "no inner minimum");
  EXPECT_EQ(back.loops.at(0).points, measures.loops[0].points);
  EXPECT_EQ(back.missing.at(0).name, "neck_front");
  EXPECT_EQ(back.missing.at(0).reason, "no head");
}

TEST(BodyMessages, ATransformThatIsNoneIsRefused) {
  Landmarks message = to_message(some_tag(), geometry::BodyMeasures());
  message.body_from_scan[0] = 2;
  EXPECT_EQ(code_of([&] { measures_in(message); }), "bad_mesh");
}

TEST(BodyMessages, ControlMeshComesBackBitForBit) {
  const geometry::ControlMesh control = small_control_mesh();
  const geometry::ControlMesh back = control_in(to_message(some_tag(), control));
  EXPECT_EQ(back.outer, control.outer);
  EXPECT_EQ(back.inner, control.inner);
  EXPECT_EQ(back.triangles, control.triangles);
  EXPECT_EQ(back.outer_fixed, control.outer_fixed);
  EXPECT_EQ(back.inner_fixed, control.inner_fixed);
  EXPECT_EQ(back.names, control.names);
  EXPECT_EQ(back.regions.at(0).name, "bust");
  EXPECT_EQ(back.regions.at(0).triangles, control.regions[0].triangles);
  EXPECT_EQ(back.lines.at(0).name, "chest");
  EXPECT_EQ(back.lines.at(0).nodes, control.lines[0].nodes);
}

}  // namespace
}  // namespace tensegric_fit::node
