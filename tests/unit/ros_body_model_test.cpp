/// The registered body model between the stages: as a message, and beside its body mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "body_model/model_message.hpp"
#include "body_model/parts.hpp"
#include "body_model/registration.hpp"
#include "geometry/status.hpp"
#include "landmarks/landmarks_handler.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "ros/body_messages.hpp"
#include "ros/model_skin_message.hpp"
#include "xyz_cloud.hpp"

namespace tensegric_fit::node {
namespace {

using body_model::RegisteredBody;

const std::shared_ptr<const body_model::Model>& shipped() {
  return body_model::shipped_registrar().shared_model();
}

/// The mean woman with bent elbows, somewhere in a booth: what a perfect registration to her own skin finds.
const RegisteredBody& woman() {
  static const RegisteredBody body = [] {
    RegisteredBody registered;
    registered.model = shipped();
    body_model::Parameters& p = registered.parameters;
    p = body_model::Parameters(*shipped());
    p.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    p.position = {0.2, -1.0 / 3, 0.9};
    p.log_scale = std::log(1.02);
    p.turns[shipped()->group_named("forearm_L")] = {0.1, 0.05, -0.02};
    p.shape[0] = -0.5;
    p.shape[3] = 1.0 / 3;
    const body_model::PosedModel posed(*shipped(), p);
    registered.posed = registered.skin = posed.vertices();
    registered.off.assign(registered.skin.size(), 0);
    registered.support.assign(registered.skin.size(), 0.001);
    registered.residual = 0.003;
    for (std::size_t b = 0; b < shipped()->bones.size(); ++b)
      registered.joints.push_back(posed.joint(static_cast<int>(b)));
    for (std::size_t i = 0; i < shipped()->bone_points.size(); ++i)
      registered.bone_points.push_back(posed.bone_point(static_cast<int>(i)));
    registered.scanned = false;
    registered.ground = geometry::bounding_box(registered.skin)[0].z();
    registered.ground_deviation = 0.002;
    return registered;
  }();
  return body;
}

geometry::TriangleMesh her_mesh() {
  return {woman().skin, shipped()->triangles};
}

ScanTag tag(const std::string& scan_id) {
  ScanTag tag;
  tag.header.stamp = ros::Time(12, 34);
  tag.header.frame_id = "booth";
  tag.scan_id = scan_id;
  return tag;
}

BodyModel model_message(const std::string& scan_id) {
  return to_message(tag(scan_id), woman(), body_model::parts_of(her_mesh(), woman()));
}

BodyModel::ConstPtr model_of(const std::string& scan_id) {
  return boost::make_shared<BodyModel>(model_message(scan_id));
}

TriangleMesh::ConstPtr mesh_of(const std::string& scan_id) {
  return boost::make_shared<TriangleMesh>(to_message(tag(scan_id), her_mesh(), {}));
}

LandmarksHandler landmarks_handler() {
  return LandmarksHandler(Parameters(YAML::Node(), "landmarks"));
}

std::string code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

double farthest(const std::vector<Eigen::Vector3d>& one, const std::vector<Eigen::Vector3d>& other) {
  if (one.size() != other.size()) return std::numeric_limits<double>::infinity();
  double distance = 0;
  for (std::size_t i = 0; i < one.size(); ++i) distance = std::max(distance, (one[i] - other[i]).norm());
  return distance;
}

TEST(BodyModelMessage, ComesBackAsItWas) {
  const BodyModel message = model_message("A");
  EXPECT_EQ(message.scan_id, "A");
  EXPECT_EQ(message.header.frame_id, "booth");
  EXPECT_EQ(message.model.size(), 16u);
  EXPECT_NEAR(message.stature, 1.02 * shipped()->stature, 1e-12);
  const RegisteredBody back = registered_in(message, shipped());
  EXPECT_EQ(back.parameters.rotation, woman().parameters.rotation);
  EXPECT_EQ(back.parameters.position, woman().parameters.position);
  EXPECT_NEAR(back.parameters.log_scale, woman().parameters.log_scale, 1e-15);
  EXPECT_EQ(back.parameters.turns, woman().parameters.turns);
  EXPECT_EQ(back.parameters.shape, woman().parameters.shape);
  EXPECT_EQ(back.residual, woman().residual);
  EXPECT_EQ(back.joints, woman().joints);
  EXPECT_EQ(back.bone_points, woman().bone_points);
  EXPECT_EQ(back.vertical, woman().vertical);
  EXPECT_EQ(back.ground, woman().ground);
  EXPECT_EQ(back.ground_deviation, woman().ground_deviation);
  EXPECT_EQ(back.scanned, woman().scanned);
  EXPECT_LE(farthest(back.skin, woman().skin), 2e-7);  // float32 at 2 m
  EXPECT_LE(farthest(back.posed, woman().posed), 1e-12);
  EXPECT_EQ(back.off.size(), woman().off.size());
  EXPECT_FLOAT_EQ(static_cast<float>(back.support[7]), 0.001F);
}

TEST(BodyModelMessage, NamesThePartOfEachVertexOfSkinAndMesh) {
  const BodyModel message = model_message("A");
  EXPECT_EQ(message.skin_parts, shipped()->part);
  EXPECT_EQ(message.mesh_parts, shipped()->part);  // the mesh is her own skin
  geometry::TriangleMesh apart = her_mesh();
  for (Eigen::Vector3d& vertex : apart.vertices) vertex += Eigen::Vector3d(5, 0, 0);
  for (const unsigned char part : body_model::parts_of(apart, woman()))
    ASSERT_EQ(part, body_model::kUnknownPart);
}

TEST(BodyModelMessage, WhatDoesNotFitTheModelIsRefusedByName) {
  const BodyModel good = model_message("A");
  const auto refused = [&good](const std::function<void(BodyModel&)>& spoil) {
    BodyModel bad = good;
    spoil(bad);
    return code_of([&] { registered_in(bad, shipped()); });
  };
  EXPECT_EQ(refused([](BodyModel&) {}), "accepted");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.model = "0123456789abcdef"; }), "other_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.model.clear(); }), "other_model");
  for (const auto& numbers : {&BodyModel::vertices, &BodyModel::off, &BodyModel::support}) {
    EXPECT_EQ(refused([&](BodyModel& bad) { (bad.*numbers).pop_back(); }), "bad_model");
    EXPECT_EQ(refused([&](BodyModel& bad) { (bad.*numbers)[4] = std::nanf(""); }), "non_finite");
  }
  for (const auto& numbers :
       {&BodyModel::turns, &BodyModel::shape, &BodyModel::joints, &BodyModel::bone_points}) {
    EXPECT_EQ(refused([&](BodyModel& bad) { (bad.*numbers).push_back(0); }), "bad_model");
    EXPECT_EQ(refused([&](BodyModel& bad) { (bad.*numbers).clear(); }), "bad_model");
    EXPECT_EQ(refused([&](BodyModel& bad) { (bad.*numbers)[0] = std::nan(""); }), "non_finite");
  }
  for (const auto& names : {&BodyModel::pose_groups, &BodyModel::bones, &BodyModel::bone_point_names})
    EXPECT_EQ(refused([&](BodyModel& bad) { std::swap((bad.*names)[0], (bad.*names)[1]); }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.rotation[0] = 2; }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.up[2] = 2; }), "bad_model");
  for (const double scale : {0.0, -1.0, 1e-6, 1e6})
    EXPECT_EQ(refused([scale](BodyModel& bad) { bad.scale = scale; }), "bad_model") << scale;
  for (const double residual : {0.0, 1e-300, 0.06, 1e300})
    EXPECT_EQ(refused([residual](BodyModel& bad) { bad.residual = residual; }), "bad_model") << residual;
  for (const double deviation : {-0.001, 1e300})
    EXPECT_EQ(refused([deviation](BodyModel& bad) { bad.ground_deviation = deviation; }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.ground = 5e13; }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.position[1] = -1e300; }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.shape[2] = 1e300; }), "bad_model");
  EXPECT_EQ(refused([](BodyModel& bad) { bad.support[3] = -1; }), "bad_model");
  for (double BodyModel::*number :
       {&BodyModel::residual, &BodyModel::ground, &BodyModel::ground_deviation, &BodyModel::scale})
    EXPECT_EQ(refused([&](BodyModel& bad) { bad.*number = std::nan(""); }), "non_finite");
}

TEST(BodyModelMessage, ASkinToBeDrawnNeedsNoModelFile) {
  BodyModel message = model_message("A");
  message.model = "of another build";
  const inspect::ModelSkin skin = skin_in(message);
  EXPECT_EQ(skin.quads, shipped()->quads);
  EXPECT_EQ(inspect::triangles_of(skin), shipped()->triangles);
  message.quads[5] = 4000000000u;
  EXPECT_EQ(code_of([&] { skin_in(message); }), "bad_model");
  message.quads.pop_back();
  EXPECT_EQ(code_of([&] { skin_in(message); }), "bad_model");
}

std::string fact(const LandmarksHandler::Output& output, const std::string& name) {
  for (const auto& [key, value] : output.facts)
    if (key == name) return value;
  return "no such fact";
}

TEST(LandmarksHandlerTest, FindsLandmarksOnMeshAndModelInAnyOrderOfArrival) {
  LandmarksHandler stage = landmarks_handler();
  EXPECT_FALSE(stage.add(model_of("A")));
  const auto first = stage.add(mesh_of("A"));
  ASSERT_TRUE(first);
  EXPECT_FALSE(stage.alone());  // nothing waits
  EXPECT_FALSE(stage.add(mesh_of("B")));
  const auto second = stage.add(model_of("B"));
  ASSERT_TRUE(second);
  const LandmarksHandler::Output output = stage.handle(*second);
  EXPECT_EQ(output.landmarks->scan_id, "B");
  EXPECT_EQ(fact(output, "body_model"), "came with the mesh");
  const geometry::BodyMeasures direct =
      landmarks::find_landmarks(her_mesh(), {}, woman(), landmarks::shipped_precision());
  ASSERT_EQ(output.measures.landmarks.size(), direct.landmarks.size());
  for (std::size_t i = 0; i < direct.landmarks.size(); ++i)
    EXPECT_LE((output.measures.landmarks[i].position - direct.landmarks[i].position).norm(), 1e-4)
        << direct.landmarks[i].name;  // float32 lets a place between two vertices be the other of them
}

TEST(LandmarksHandlerTest, AModelOfAnotherScanIsNeverUsed) {
  LandmarksHandler stage = landmarks_handler();
  EXPECT_FALSE(stage.add(model_of("B")));
  EXPECT_FALSE(stage.add(mesh_of("A")));
  EXPECT_FALSE(stage.add(model_of("C")));
  EXPECT_FALSE(stage.add(mesh_of("D")));  // A is not waited for any more
  EXPECT_FALSE(stage.add(model_of("A")));
  const auto alone = stage.alone();
  ASSERT_TRUE(alone);
  EXPECT_EQ(std::get<0>(*alone)->scan_id, "D");
  EXPECT_FALSE(std::get<1>(*alone));
  const auto late = stage.add(model_of("D"));  // it is measured once more, as without the delay
  ASSERT_TRUE(late);
  EXPECT_EQ(std::get<0>(*late)->scan_id, "D");
  EXPECT_TRUE(std::get<1>(*late));
  EXPECT_FALSE(stage.add(model_of("D")));
}

TEST(LandmarksHandlerTest, NoModelIsKeptOfAScanBeforeAMeshThatComesAlone) {
  LandmarksHandler stage = landmarks_handler();
  const BodyModel::ConstPtr before = model_of("A");
  stage.add(before);
  ASSERT_TRUE(stage.add(mesh_of("A")));
  stage.add(mesh_of("B"));
  EXPECT_GT(before.use_count(), 1);
  ASSERT_TRUE(stage.alone());
  EXPECT_EQ(before.use_count(), 1);
}

TEST(LandmarksHandlerTest, RegistersTheModelToAMeshThatComesAlone) {
  LandmarksHandler stage = landmarks_handler();
  stage.add(mesh_of("A"));
  const auto alone = stage.alone();
  ASSERT_TRUE(alone);
  const LandmarksHandler::Output output = stage.handle(*alone);
  EXPECT_EQ(fact(output, "body_model"), "registered to the mesh");
  const geometry::BodyMeasures direct =
      landmarks::find_landmarks(her_mesh(), {}, woman(), landmarks::shipped_precision());
  for (const char* name : {"bust", "underbust", "crotch"})
    EXPECT_NEAR(output.measures.height(name), direct.height(name), 0.004) << name;  // ISO 20685
}

TEST(LandmarksHandlerTest, AMeshThatReachesHigherThanAnybodyIsRefused) {
  const LandmarksHandler stage = landmarks_handler();
  geometry::TriangleMesh mesh = her_mesh();
  mesh.vertices.back().z() = 1e6;  // slabs of 2 cm would take gigabytes
  const auto message = boost::make_shared<TriangleMesh>(to_message(tag("A"), mesh, {}));
  EXPECT_EQ(code_of([&] { stage.handle({message, model_of("A")}); }), "bad_mesh");
}

TEST(TriangleMeshMessage, AnyByteButZeroIsAFlag) {
  TriangleMesh message = to_message(tag("A"), her_mesh(), {});
  message.filled[1] = 255;
  message.filled[2] = 2;
  const std::vector<char> filled = filled_in(message);
  EXPECT_EQ(filled[0], 0);
  EXPECT_EQ(filled[1], 1);
  EXPECT_EQ(filled[2], 1);
}

// An older bag has the mesh without its model.
TEST(LandmarksHandlerTest, AMeshWithFillingsThatComesAloneIsAScans) {
  const auto half_width = [](const std::vector<char>& filled) {
    LandmarksHandler stage = landmarks_handler();
    stage.add(boost::make_shared<TriangleMesh>(to_message(tag("A"), her_mesh(), filled)));
    for (const geometry::Measure& height : stage.handle(*stage.alone()).measures.heights)
      if (height.name == "bust") return height.half_width;
    return 0.0;
  };
  std::vector<char> filled(her_mesh().vertices.size(), 0);
  const double given = half_width(filled);
  EXPECT_EQ(given, half_width({})) << "no flag is set";
  filled.front() = 1;
  EXPECT_GT(half_width(filled), given + 0.001) << "a scan's: where its floor was is not known";
}

TEST(LandmarksHandlerTest, AModelThatDoesNotFitTheMeshIsRefusedByName) {
  const LandmarksHandler stage = landmarks_handler();
  const auto code_with = [&](const std::function<void(BodyModel&)>& spoil) {
    BodyModel bad = model_message("A");
    spoil(bad);
    return code_of([&] { stage.handle({mesh_of("A"), boost::make_shared<BodyModel>(bad)}); });
  };
  EXPECT_EQ(code_with([](BodyModel& bad) { bad.mesh_parts.pop_back(); }), "bad_model");
  EXPECT_EQ(code_with([](BodyModel& bad) { bad.mesh_parts[0] = 99; }), "bad_model");
  EXPECT_EQ(code_with([](BodyModel& bad) { bad.mesh_parts[0] = body_model::kUnknownPart; }), "accepted");
  EXPECT_EQ(code_with([](BodyModel& bad) { bad.model = "of another build"; }), "other_model");
}

sensor_msgs::PointCloud2 scan_of_her() {
  constexpr int kPoints = 60000;
  const std::vector<Eigen::Vector3d> points = body_model::sample_surface(her_mesh(), {}, kPoints).points;
  sensor_msgs::PointCloud2 scan = xyz_cloud(points.size());
  scan.header.stamp = ros::Time(12, 34);
  scan.is_dense = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points[i].cast<float>();
    std::memcpy(&scan.data[12 * i], p.data(), 12);
  }
  return scan;
}

TEST(ReconstructionHandlerTest, MeshAndModelAreOfOneScan) {
  const ReconstructionHandler stage(
      Parameters(YAML::Load("{body_triangles: 20000, poisson_depth: 7}"), "reconstruction"));
  const sensor_msgs::PointCloud2 scan = scan_of_her();
  const ReconstructionHandler::Output output = stage.handle(scan, tag_of(scan));
  EXPECT_EQ(output.mesh->scan_id, tag_of(scan).scan_id);
  EXPECT_EQ(output.model->scan_id, output.mesh->scan_id);
  EXPECT_EQ(output.model->header.stamp, output.mesh->header.stamp);
  EXPECT_EQ(output.model->header.frame_id, output.mesh->header.frame_id);
  EXPECT_TRUE(output.model->scanned);
  EXPECT_LT(output.model->residual, 0.005);  // m; the mean woman of the model herself
  ASSERT_EQ(3 * output.model->mesh_parts.size(), output.mesh->vertices.size());
  EXPECT_EQ(
      std::count(output.model->mesh_parts.begin(), output.model->mesh_parts.end(), body_model::kUnknownPart),
      0);

  LandmarksHandler landmarks = landmarks_handler();
  landmarks.add(output.model);
  const auto joined = landmarks.add(output.mesh);
  ASSERT_TRUE(joined);
  const geometry::BodyMeasures measures = landmarks.handle(*joined).measures;
  const Eigen::Vector3d tip = woman().skin_point("bust_point_L");
  EXPECT_LE((measures.landmark("bust_point_L") - tip).norm(), 0.01);
}

}  // namespace
}  // namespace tensegric_fit::node
