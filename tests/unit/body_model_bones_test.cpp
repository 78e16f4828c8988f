// The assumed rib cage and pelvis: under the skin of every body, posed with her, the same on both sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <sstream>

#include "body_model/bones.hpp"
#include "body_model/registration.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "geometry/winding_number.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

const std::string kBones = geometry::shipped_folder("body_model") + "/bones.tfb";

RegisteredBody body_of(const Parameters& parameters) {
  RegisteredBody body;
  body.model = shipped_registrar().shared_model();
  body.parameters = parameters;
  body.posed = body.skin = PosedModel(*body.model, parameters).vertices();
  return body;
}

/// A woman of the model, arms and spine as a booth sees them.
Parameters random_woman(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Parameters parameters(shipped_registrar().model());
  for (double& coefficient : parameters.shape) coefficient = normal(random);
  const auto& groups = shipped_registrar().model().groups;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (int i = 0; i < 3; ++i) parameters.turns[g][i] = 0.5 * groups[g].spread[i] * normal(random);
  return parameters;
}

double depth_at(const RegisteredBody& body, const Vector3d& skin) {
  const auto bones = bones_of(body, shipped_bones());
  return Tissue(bones).depth(skin).distance;
}

TEST(Bones, AreARibCageAndAPelvis) {
  const auto& shapes = shipped_bones();
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(shapes[0].name, "rib_cage");
  EXPECT_EQ(shapes[1].name, "pelvis");
  const auto bones = bones_of(body_of(Parameters(shipped_registrar().model())), shapes);
  const auto size = [](const geometry::TriangleMesh& mesh) -> Vector3d {
    const auto box = geometry::bounding_box(mesh.vertices);
    return box[1] - box[0];
  };
  // Calipers on 260 women, scaled to a stature of 1.70 m: chest 269 mm wide and 183 deep, pelvis 284 wide
  // (Heinz et al. 2003), with some 5 mm of pressed tissue a side. Assumed bones are within a tenth of that.
  EXPECT_NEAR(size(bones[0].mesh).x(), 0.259, 0.026);
  EXPECT_NEAR(size(bones[1].mesh).x(), 0.274, 0.027);
  for (const BoneSurface& bone : bones) {
    geometry::check_mesh(bone.mesh);
    // Counter-clockwise from outside: normals away from the upright through the middle.
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : bone.mesh.vertices) middle += p / static_cast<double>(bone.mesh.vertices.size());
    for (const Eigen::Vector3i& t : bone.mesh.triangles) {
      const Vector3d &a = bone.mesh.vertices[t[0]], &b = bone.mesh.vertices[t[1]],
                     &c = bone.mesh.vertices[t[2]];
      Vector3d out = (a + b + c) / 3 - middle;
      out.z() = 0;
      EXPECT_GT(geometry::area_vector(a, b, c).dot(out), 0);
    }
  }
}

TEST(Bones, LieUnderTheSkinOfEveryWomanInEveryPose) {
  std::mt19937 random(7);
  for (int woman = 0; woman < 20; ++woman) {
    const RegisteredBody body = body_of(random_woman(random));
    const geometry::TriangleMesh skin{body.skin, body.model->triangles};
    std::vector<char> trunk;  // arms may lie against it
    for (const Eigen::Vector3i& t : skin.triangles)
      trunk.push_back(std::max({body.model->arm[t[0]], body.model->arm[t[1]], body.model->arm[t[2]]}) < 0.5);
    const geometry::TriangleMesh trunk_skin = geometry::submesh(skin, trunk);
    const geometry::SurfaceTree tree(trunk_skin);
    const auto bones = bones_of(body, shipped_bones());
    for (const BoneSurface& bone : bones) {
      for (std::size_t i = 0; i < bone.mesh.vertices.size(); ++i) {
        const Vector3d& p = bone.mesh.vertices[i];
        EXPECT_GE((tree.nearest(p).position - p).norm(), kThinnestTissue - 1e-9)
            << "woman " << woman << ", " << bone.name << ", point " << i;
        if (i % 8 != 0) continue;
        EXPECT_GT(geometry::winding_number(skin, p), 0.5)
            << "woman " << woman << ", " << bone.name << ", point " << i;
      }
    }
    const Tissue tissue(bones);
    for (const char* place : {"bust_point_L", "bust_point_R", "underbust_L", "underbust_R", "navel"}) {
      const auto depth = tissue.depth(body.skin_point(place));
      EXPECT_GT(depth.distance, 0);
      EXPECT_LT(depth.distance, 0.25) << "woman " << woman << ", " << place;
    }
  }
}

TEST(Bones, AreTheSameOnBothSidesOfASymmetricBody) {
  const RegisteredBody body = body_of(Parameters(shipped_registrar().model()));
  const auto bones = bones_of(body, shipped_bones());
  const Tissue tissue(bones);
  for (std::size_t v = 0; v < body.skin.size(); v += 7) {
    if (body.skin[v].z() < 0 || body.skin[v].z() > 0.5) continue;
    const double here = tissue.depth(body.skin[v]).distance,
                 there = tissue.depth(body.skin[v].cwiseProduct(Vector3d(-1, 1, 1))).distance;
    // Points are mirror images; the diagonals of quads are not.
    EXPECT_NEAR(here, there, 0.001) << "vertex " << v;
  }
}

TEST(Bones, FollowTheBodyAndNotTheArms) {
  std::mt19937 random(3);
  Parameters parameters = random_woman(random);
  const RegisteredBody body = body_of(parameters);
  const double depth = depth_at(body, body.skin_point("navel"));
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(0.3, -2, 1) * Eigen::AngleAxisd(1.1, Vector3d(0.1, 0.2, 0.97).normalized());
  EXPECT_NEAR(depth_at(moved(body, motion), motion * body.skin_point("navel")), depth, 1e-6);

  // As raised arms leave it: skin that they carry along may press points down, nothing else.
  Parameters raised = parameters;
  for (const char* arm : {"arm_L", "arm_R"}) raised.turns[body.model->group_named(arm)].y() += 0.5;
  const auto before = bones_of(body, shipped_bones()), after = bones_of(body_of(raised), shipped_bones());
  for (std::size_t i = 0; i < before[1].mesh.vertices.size(); ++i)
    EXPECT_NEAR((before[1].mesh.vertices[i] - after[1].mesh.vertices[i]).norm(), 0, 1e-6);
}

TEST(Bones, ThicknessGrowsWithTheBreast) {
  // The first shape component is a woman's build: heavier one way. Bones hardly grow with it.
  Parameters lean(shipped_registrar().model()), heavy = lean;
  const auto girth = [](const Parameters& parameters) {
    const auto box = geometry::bounding_box(body_of(parameters).skin);
    return (box[1] - box[0]).y();
  };
  lean.shape[0] = -1.5;
  heavy.shape[0] = 1.5;
  if (girth(lean) > girth(heavy)) std::swap(lean, heavy);
  const RegisteredBody a = body_of(lean), b = body_of(heavy);
  for (const char* place : {"bust_point_L", "bust_point_R", "navel"})
    EXPECT_GT(depth_at(b, b.skin_point(place)), depth_at(a, a.skin_point(place)) + 0.01) << place;
}

std::string refusal_with(const std::string& what, const std::string& by,
                         std::size_t keep = std::string::npos) {
  std::ifstream in(kBones, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  std::string changed = text.str();
  const std::size_t at = changed.find(what);
  if (at == std::string::npos) return "the file does not contain " + what;
  changed.replace(at, what.size(), by);
  const std::string path = testing::TempDir() + "bones.tfb";
  std::ofstream(path, std::ios::binary) << changed.substr(0, keep);
  try {
    load_bones(path, shipped_registrar().model());
  } catch (const geometry::Refusal& refusal) {
    return refusal.code() + ": " + refusal.what();
  }
  return "";
}

TEST(Bones, OfAnotherFormatOrModelAreRefusedByName) {
  const std::string checksum = shipped_registrar().model().checksum;
  EXPECT_EQ(refusal_with(checksum, checksum), "");
  EXPECT_NE(refusal_with(checksum, "0123456789abcdef").find("other_model"), std::string::npos);
  EXPECT_NE(refusal_with("bones 1", "bones 2").find("not a file of bones of this format"), std::string::npos);
  EXPECT_NE(refusal_with("\"pelvis\"", "\"pelvic\"").find("broken_file"), std::string::npos);
  EXPECT_NE(refusal_with(checksum, checksum, 100000).find("truncated"), std::string::npos);
}

}  // namespace
}  // namespace tensegric_fit::body_model
