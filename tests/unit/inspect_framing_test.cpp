/// Where the camera stands to show a body.
#include <gtest/gtest.h>

#include <cmath>

#include "inspect/framing.hpp"

namespace tensegric_fit::inspect {
namespace {

using Eigen::Vector3d;

constexpr double kAngle = M_PI / 4;

/// Corners of a box 0.3 m deep, 0.5 m wide and 1.7 m high, in the body's frame.
std::vector<Vector3d> corners() {
  std::vector<Vector3d> all;
  for (const double x : {-0.15, 0.15})
    for (const double y : {-0.25, 0.25})
      for (const double z : {0.0, 1.7}) all.emplace_back(x, y, z);
  return all;
}

/// She stands 2 m off the origin and faces 130 degrees from x.
Eigen::Isometry3d scan_from_body() {
  return Eigen::Translation3d(2, -1, 0.1) * Eigen::AngleAxisd(130 * M_PI / 180, Vector3d::UnitZ());
}

std::vector<Vector3d> in_scan(std::vector<Vector3d> points) {
  for (Vector3d& p : points) p = scan_from_body() * p;
  return points;
}

Vector3d eye_of(const OrbitView& view) {
  return view.focus + view.distance * Vector3d(std::cos(view.yaw) * std::cos(view.pitch),
                                               std::sin(view.yaw) * std::cos(view.pitch),
                                               std::sin(view.pitch));
}

TEST(FramingTest, ShowsAllOfHerFromEachSideWhereverSheStands) {
  const Eigen::Isometry3d body_from_scan = scan_from_body().inverse();
  for (const auto& [from, side] : {std::pair{From::front, Vector3d(1, 0, 0)},
                                   {From::her_left, Vector3d(0, 1, 0)},
                                   {From::back, Vector3d(-1, 0, 0)},
                                   {From::her_right, Vector3d(0, -1, 0)}}) {
    const OrbitView view = framed(in_scan(corners()), body_from_scan, from, 0, kAngle);
    const Vector3d eye = eye_of(view), in_body = body_from_scan * eye;
    EXPECT_GT((in_body - Vector3d(0, 0, in_body.z())).normalized().dot(side), 0.999) << "seen from there";
    const Vector3d forward = (view.focus - eye).normalized();
    const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized(), up = right.cross(forward);
    double most = 0;
    for (const Vector3d& corner : in_scan(corners())) {
      const Vector3d seen = corner - eye;
      EXPECT_GT(seen.dot(forward), 0.1);
      for (const Vector3d& axis : {right, up})
        most = std::max(most, std::abs(seen.dot(axis)) / seen.dot(forward));
    }
    EXPECT_LT(most, 1.05 * std::tan(kAngle / 2)) << "in the picture, but for what the pitch moves";
    EXPECT_GT(most, 0.8 * std::tan(kAngle / 2)) << "and fills it";
  }
}

TEST(FramingTest, AGarmentBehindIsSeenFromBehind) {
  const Eigen::Isometry3d body_from_scan = scan_from_body().inverse();
  EXPECT_TRUE(lie_behind(in_scan({{-0.12, 0, 0.9}}), in_scan(corners()), body_from_scan));
  EXPECT_FALSE(lie_behind(in_scan({{0.12, 0, 1.2}}), in_scan(corners()), body_from_scan));
}

TEST(FramingTest, AStepAsideOrATurnIsAnotherPlace) {
  const Eigen::Isometry3d there = scan_from_body().inverse();
  const auto moved = [&](const Eigen::Isometry3d& by) {
    return is_moved((scan_from_body() * by).inverse(), there);
  };
  EXPECT_FALSE(moved(Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(moved(Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.1, 0))));
  EXPECT_TRUE(moved(Eigen::Isometry3d(Eigen::Translation3d(0.3, 0, 0))));
  EXPECT_FALSE(moved(Eigen::Isometry3d(Eigen::AngleAxisd(0.2, Vector3d::UnitZ()))));
  EXPECT_TRUE(moved(Eigen::Isometry3d(Eigen::AngleAxisd(0.4, Vector3d::UnitZ()))));
}

}  // namespace
}  // namespace tensegric_fit::inspect
