#include "inspect/framing.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::inspect {
namespace {

using Eigen::Vector3d;
constexpr double kPitch = 0.1;  // rad: a little from above, as one looks at somebody

double turn_of(From from) {
  switch (from) {
    case From::front:
      return 0;
    case From::her_left:
      return M_PI / 2;
    case From::back:
      return M_PI;
    case From::her_right:
      return -M_PI / 2;
  }
  return 0;
}

}  // namespace

OrbitView framed(const std::vector<Vector3d>& points, const Eigen::Isometry3d& body_from_scan, From from,
                 double margin, double angle) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(body_from_scan * p);
  const Vector3d size = box.sizes() + Vector3d::Constant(2 * margin);
  const bool along_x = from == From::front || from == From::back;
  const double wide = along_x ? size.y() : size.x(), deep = along_x ? size.x() : size.y();
  const Eigen::Isometry3d scan_from_body = body_from_scan.inverse();
  const Vector3d forward = scan_from_body.linear() * Vector3d::UnitX();
  OrbitView view;
  view.focus = scan_from_body * box.center();
  view.distance = std::max(wide, size.z()) / 2 / std::tan(angle / 2) + deep / 2;
  view.yaw = std::remainder(std::atan2(forward.y(), forward.x()) + turn_of(from), 2 * M_PI);
  view.pitch = kPitch;
  return view;
}

bool lie_behind(const std::vector<Vector3d>& points, const std::vector<Vector3d>& skin,
                const Eigen::Isometry3d& body_from_scan) {
  const auto mean_x = [&](const std::vector<Vector3d>& all) {
    double sum = 0;
    for (const Vector3d& p : all) sum += (body_from_scan * p).x();
    return sum / static_cast<double>(all.size());
  };
  return mean_x(points) < mean_x(skin);
}

bool is_moved(const Eigen::Isometry3d& body_from_scan, const Eigen::Isometry3d& before) {
  constexpr double kFar = 0.2, kTurned = 15 * M_PI / 180;
  const Eigen::Isometry3d change = before * body_from_scan.inverse();
  return change.translation().norm() > kFar || Eigen::AngleAxisd(change.rotation()).angle() > kTurned;
}

}  // namespace tensegric_fit::inspect
