/// Where the depth cameras of a booth stand.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace tensegric_fit::depth_cameras {

/// booth_from_camera of each of `cameras`, in their order, from a YAML file:
///     cameras:
///       left: {position: [1.0, 1.0, 0.5], rotation: [[...], [...], [...]]}
/// Metres; `rotation` has the rows of the matrix that turns the camera's optical frame (x right, y down, z
/// the way it looks) into the booth's (z up), or `quaternion: [x, y, z, w]` in its place. What is a rotation
/// but for rounding (kRounding) is made one. \throw Refusal bad_option naming the camera: the file cannot be
/// read, an unknown key, a camera that is missing or that is not asked for, a motion that is not rigid
std::vector<Eigen::Isometry3d> load_camera_poses(const std::string& path,
                                                 const std::vector<std::string>& cameras);

/// Of entries of a rotation as it is written down: three decimals suffice to be understood.
inline constexpr double kRounding = 2e-3;

}  // namespace tensegric_fit::depth_cameras
