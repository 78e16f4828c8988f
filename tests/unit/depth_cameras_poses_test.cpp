/// Where depth cameras stand, from a file: every fault is named with its camera.
#include <gtest/gtest.h>

#include <fstream>

#include "depth_cameras/camera_poses.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::depth_cameras {
namespace {

std::vector<Eigen::Isometry3d> load(const std::string& yaml) {
  const std::string path = testing::TempDir() + "camera_poses.yaml";
  std::ofstream(path) << yaml;
  return load_camera_poses(path, {"left", "right"});
}

std::string refused(const std::string& yaml) {
  try {
    load(yaml);
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "bad_option");
    return refusal.what();
  }
  return "";
}

const std::string kLeft = "cameras:\n  left: {position: [1, 2, 3], quaternion: [0, 0, 0, 1]}\n";
const std::string kTurned = "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]";

TEST(CameraPosesTest, ReadsRotationsAndQuaternions) {
  const auto poses = load(kLeft + "  right: {position: [0, 0, 1.5], rotation: " + kTurned + "}\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_TRUE(poses[0].translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(poses[0].linear().isIdentity(1e-12));
  EXPECT_TRUE((poses[1] * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0, 1, 1.5)));
}

TEST(CameraPosesTest, WhatIsRoundedIsMadeRigid) {
  const auto poses =
      load(kLeft +
           "  right: {position: [0, 0, 0], rotation: [[0.707, -0.707, 0], [0.707, 0.707, 0], [0, 0, 1]]}\n");
  EXPECT_TRUE((poses[1].linear() * poses[1].linear().transpose()).isIdentity(1e-12));
}

TEST(CameraPosesTest, FaultsAreNamedWithTheCamera) {
  const std::string right = kLeft + "  right: ";
  const std::vector<std::pair<std::string, std::string>> faults = {
      {kLeft, "camera 'right' is missing"},
      {right + "{position: [0, 0, 0], rotation: " + kTurned + ", fov: 3}", "fov"},
      {right + "{position: [0, 0, 0]}", "either"},
      {right + "{position: [0, 0, 0], rotation: " + kTurned + ", quaternion: [0, 0, 0, 1]}", "either"},
      {right + "{position: [0, 0], rotation: " + kTurned + "}", "3 numbers"},
      {right + "{position: [0, .nan, 0], rotation: " + kTurned + "}", "3 numbers"},
      {right + "{position: [0, 1400, 0], rotation: " + kTurned + "}", "metres"},
      {right + "{position: [0, 0, 0], rotation: [[1, 0, 0], [0, 1, 0], [0, 0.1, 1]]}", "not rigid"},
      {right + "{position: [0, 0, 0], rotation: [[2, 0, 0], [0, 2, 0], [0, 0, 2]]}", "not rigid"},
      {right + "{position: [0, 0, 0], rotation: [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}", "mirrors"},
      {right + "{position: [0, 0, 0], rotation: [[1, 0], [0, 1, 0], [0, 0, 1]]}", "three rows"},
      {right + "{position: [0, 0, 0], quaternion: [0, 0, 0, 2]}", "quaternion"},
      {right + "3", "map"}};
  for (const auto& [yaml, words] : faults) {
    const std::string said = refused(yaml);
    EXPECT_NE(said.find(words), std::string::npos) << yaml << "\nsaid: " << said;
    EXPECT_NE(said.find("right"), std::string::npos) << said;
  }
  EXPECT_NE(refused(kLeft + "  middle: {}").find("none of the booth's"), std::string::npos);
  EXPECT_NE(refused("cameras: 3").find("'cameras'"), std::string::npos);
  EXPECT_NE(refused("poses: {}").find("poses"), std::string::npos);
}

}  // namespace
}  // namespace tensegric_fit::depth_cameras
