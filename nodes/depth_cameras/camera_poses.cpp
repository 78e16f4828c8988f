#include "depth_cameras/camera_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::depth_cameras {
namespace {

namespace refusal = geometry::refusal;

[[noreturn]] void refuse(const std::string& where, const std::string& why) {
  throw geometry::Refusal(refusal::kBadOption, where + ": " + why);
}

std::vector<double> numbers(const YAML::Node& map, const char* key, std::size_t count,
                            const std::string& where) {
  const auto values = geometry::required<std::vector<double>>(map, key, where, refusal::kBadOption);
  const bool finite =
      std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (values.size() != count || !finite) refuse(where, fmt::format("'{}' must be {} numbers", key, count));
  return values;
}

Eigen::Matrix3d from_quaternion(const YAML::Node& map, const std::string& where) {
  const std::vector<double> q = numbers(map, "quaternion", 4, where);
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  if (std::abs(turn.norm() - 1) > kRounding)
    refuse(where, fmt::format("the quaternion is {:.4f} long; that of a rotation is 1 long", turn.norm()));
  return turn.normalized().toRotationMatrix();
}

Eigen::Matrix3d from_rows(const YAML::Node& map, const std::string& where) {
  const auto rows =
      geometry::required<std::vector<std::vector<double>>>(map, "rotation", where, refusal::kBadOption);
  Eigen::Matrix3d turn;
  if (rows.size() != 3) refuse(where, "'rotation' must be three rows of three numbers");
  for (int row = 0; row < 3; ++row) {
    if (rows[row].size() != 3) refuse(where, "'rotation' must be three rows of three numbers");
    for (int column = 0; column < 3; ++column) turn(row, column) = rows[row][column];
  }
  if (!turn.allFinite()) refuse(where, "'rotation' must be three rows of three numbers");
  const double off = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kRounding))
    refuse(where,
           fmt::format("'rotation' is not rigid: its rows are not unit vectors at right angles, by {:.3g}",
                       off));
  if (turn.determinant() < 0) refuse(where, "'rotation' mirrors: it makes a left hand of a right one");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Isometry3d pose_of(const YAML::Node& camera, const std::string& where) {
  if (!camera.IsMap()) refuse(where, "must be a map of 'position' and 'rotation'");
  geometry::check_keys(camera, {"position", "rotation", "quaternion"}, where, refusal::kBadOption);
  if (camera["rotation"].IsDefined() == camera["quaternion"].IsDefined())
    refuse(where, "must have either 'rotation' or 'quaternion'");
  const std::vector<double> at = numbers(camera, "position", 3, where);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(at[0], at[1], at[2]);
  pose.linear() = camera["rotation"] ? from_rows(camera, where) : from_quaternion(camera, where);
  constexpr double kFarthest = 20;  // metres; a booth has room for one person
  if (pose.translation().norm() > kFarthest)
    refuse(where, fmt::format("'position' is {:.0f} m from the booth's origin; positions are in metres",
                              pose.translation().norm()));
  return pose;
}

}  // namespace

std::vector<Eigen::Isometry3d> load_camera_poses(const std::string& path,
                                                 const std::vector<std::string>& cameras) {
  const YAML::Node file = geometry::load_yaml_map(path, refusal::kBadOption);
  geometry::check_keys(file, {"cameras"}, path, refusal::kBadOption);
  const YAML::Node all = file["cameras"];
  if (!all || !all.IsMap()) refuse(path, "'cameras' must be a map of names to poses");
  std::vector<std::string> names;
  for (const auto& entry : all) {
    names.push_back(entry.first.Scalar());
    if (std::find(cameras.begin(), cameras.end(), names.back()) == cameras.end())
      refuse(path, "camera '" + names.back() + "' is none of the booth's");
    if (std::count(names.begin(), names.end(), names.back()) > 1)
      refuse(path, "camera '" + names.back() + "' is given twice");
  }
  std::vector<Eigen::Isometry3d> poses;
  for (const std::string& camera : cameras) {
    if (std::find(names.begin(), names.end(), camera) == names.end())
      refuse(path, "camera '" + camera + "' is missing");
    poses.push_back(pose_of(all[camera], path + ": camera '" + camera + "'"));
  }
  return poses;
}

}  // namespace tensegric_fit::depth_cameras
