// An arm that moved while sensors looked one after the other.
#include <gtest/gtest.h>

#include <algorithm>

#include "reconstruction/mending.hpp"
#include "reconstruction/normals.hpp"
#include "reconstruction/registration.hpp"
#include "reconstruction_figure.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector3d;

constexpr int kSensors = 6;
constexpr double kNoise = 0.001;  // m

struct Scan {
  std::vector<Vector3d> points, normals, truth;
  std::vector<int> sensor;
};

/// Share of the shift with which the second half of the sensors saw a point: all at the middle of one arm.
double share_of_shift(const Vector3d& p) {
  const double inside = 1 - (p - Vector3d(0.215, 0, 1.06)).squaredNorm() / (0.14 * 0.14);
  return inside > 0 ? inside * inside : 0;
}

/// Six sensors round the figure; each sees what faces it.
Scan scan_of(const Vector3d& shift) {
  const auto skin = figure::scan_body(120000, 0, 7);
  std::mt19937 random(8);
  Scan scan;
  for (std::size_t i = 0; i < skin.points.size(); ++i) {
    const int sensor = static_cast<int>(kSensors * figure::uniform(random));
    const double turn = 2 * M_PI * sensor / kSensors;
    if (skin.normals[i].dot(Vector3d(std::cos(turn), std::sin(turn), 0)) < 0.2) continue;
    const Vector3d moved =
        sensor < kSensors / 2 ? Vector3d::Zero() : Vector3d(share_of_shift(skin.points[i]) * shift);
    scan.truth.push_back(skin.points[i]);
    scan.points.push_back(skin.points[i] + moved + kNoise * figure::gaussian(random) * skin.normals[i]);
    scan.normals.push_back(skin.normals[i]);
    scan.sensor.push_back(sensor);
  }
  return scan;
}

/// How far the two halves of the sensors see the shifted skin apart along its normal, m: root mean square
/// over pieces of the arm.
double apart(const Scan& scan, const std::vector<Vector3d>& points) {
  constexpr int kPieces = 12;  // round the arm
  std::vector<double> sum[2], count[2];
  for (int half : {0, 1}) {
    sum[half].resize(kPieces);
    count[half].resize(kPieces);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (share_of_shift(scan.truth[i]) < 0.6) continue;
    const double turn = std::atan2(scan.normals[i].y(), scan.normals[i].x());
    const int piece = std::min(kPieces - 1, static_cast<int>((turn + M_PI) / (2 * M_PI) * kPieces));
    const int half = scan.sensor[i] < kSensors / 2 ? 0 : 1;
    sum[half][piece] += scan.normals[i].dot(points[i] - scan.truth[i]);
    ++count[half][piece];
  }
  double squares = 0, pieces = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    if (std::min(count[0][piece], count[1][piece]) < 20) continue;
    squares += std::pow(sum[0][piece] / count[0][piece] - sum[1][piece] / count[1][piece], 2);
    ++pieces;
  }
  return std::sqrt(squares / pieces);
}

TEST(ReconstructionMending, AnArmThatMovedBetweenSensorsIsBroughtTogether) {
  for (const Vector3d& shift :
       {Vector3d(0.012, 0, 0), Vector3d(0, 0.012, 0), Vector3d(0.007, -0.007, 0.004)}) {
    const Scan scan = scan_of(shift);
    std::vector<Vector3d> points = scan.points;
    ASSERT_TRUE(mend_fractures(points, scan.normals, scan.sensor));
    EXPECT_GT(apart(scan, scan.points), 0.003);
    EXPECT_LT(apart(scan, points), 0.3 * apart(scan, scan.points)) << shift.transpose();
    double farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((scan.truth[i] - Vector3d(0.215, 0, 1.06)).norm() > 0.4)
        farthest = std::max(farthest, (points[i] - scan.points[i]).norm());
    EXPECT_EQ(farthest, 0);  // what did not move stays
  }
}

TEST(ReconstructionMending, ABodyThatStoodStillStaysAsItIs) {
  const Scan scan = scan_of(Vector3d::Zero());
  std::vector<Vector3d> points = scan.points;
  EXPECT_FALSE(mend_fractures(points, scan.normals, scan.sensor));
  EXPECT_EQ(points, scan.points);
}

TEST(ReconstructionMending, PointsWithoutASensorStay) {
  const Scan scan = scan_of({0.012, 0, 0});
  std::vector<Vector3d> points = scan.points;
  EXPECT_FALSE(mend_fractures(points, scan.normals, {}));
  std::vector<int> some = scan.sensor;
  for (std::size_t i = 0; i < some.size(); i += 10) some[i] = -1;
  ASSERT_TRUE(mend_fractures(points, scan.normals, some));
  for (std::size_t i = 0; i < some.size(); i += 10) EXPECT_EQ(points[i], scan.points[i]);
}

// Its front is seen by sensors from before the motion, its back by others; at its sides both overlap, on skin
// that moved mostly along itself: that says about half of the shift.
TEST(ReconstructionMending, AnArmThatMovedRegainsHalfOfItsThickness) {
  const Scan scan = scan_of({0, 0.012, 0});
  const auto depth_of_arm = [&](const std::vector<Vector3d>& points) {
    double sum[2] = {0, 0}, count[2] = {0, 0};
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(scan.truth[i].z() - 1.06) > 0.015 || std::abs(scan.normals[i].y()) < 0.95 ||
          (scan.truth[i] - Vector3d(0.215, 0, 1.06)).norm() > 0.06)
        continue;
      const int back = scan.normals[i].y() > 0 ? 0 : 1;
      sum[back] += points[i].y();
      ++count[back];
    }
    return sum[0] / count[0] - sum[1] / count[1];
  };
  // As in a reconstruction, with normals that the points themselves give.
  std::vector<Vector3d> together = scan.points;
  register_sensors(together, scan.sensor);
  ASSERT_TRUE(mend_fractures(together, outward_normals(together, scan.normals), scan.sensor));
  const double depth = depth_of_arm(scan.truth), thinner = depth - depth_of_arm(scan.points),
               mended = depth - depth_of_arm(together);
  EXPECT_GT(thinner, 0.006);
  EXPECT_LT(std::abs(mended), 0.6 * thinner);
}

}  // namespace
}  // namespace tensegric_fit::reconstruction
