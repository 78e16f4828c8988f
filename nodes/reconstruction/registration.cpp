#include "reconstruction/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/percentile.hpp"
#include "geometry/points.hpp"
#include "geometry/rigid_motion.hpp"
#include "reconstruction/sensor_patches.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using geometry::SmallMotion;

constexpr double kRadius = 0.010;  // m, of a patch, at this many points
constexpr double kDense = 180000;
constexpr double kLargest = 0.025;  // m
constexpr int kStep = 3;            // cells from patch to patch
constexpr int kPasses = 2, kRounds = 4;
constexpr double kOutlier = 4.5;       // usual differences, at which a sheet counts a quarter
constexpr double kLastMotion = 1e-5;   // m
constexpr double kMotionPrior = 1e-3;  // of the usual weight, that holds a motion to zero
// m^2, patches that a sensor shares with others times their radius squared. Sensors across from each other
// share the rims of what they see, which bend away from both: 0.005 to 0.008 at 40,000 and 200,000 points;
// neighbours share 0.10 to 0.18 there, 0.025 and more of 3,500 points.
constexpr double kLeastShared = 0.015;
constexpr double kMost = 0.010;  // m and rad, of a motion
// m; sensors that a booth has registered itself differ by 0.1 to 0.3, and another registration improves
// nothing.
constexpr double kNegligible = 0.0004;

// Why not the way of the booth's assembler: it matches points by their normals, which a cloud of sensors that
// are off does not have yet; patches that several sensors see need none.

/// What a motion about `middle` adds to the first three terms of a sheet's heights.
Eigen::Matrix<double, 3, 6> terms_of_motion(const Patch& patch, double radius,
                                            const Eigen::Vector3d& middle) {
  Eigen::Matrix<double, 3, 6> result;
  result.setZero();
  result.row(0) = geometry::along_normal(patch.centre, middle, patch.normal).transpose();
  result.row(1).head<3>() = radius * patch.x.cross(patch.normal).transpose();
  result.row(2).head<3>() = radius * patch.y.cross(patch.normal).transpose();
  return result;
}

/// One round: the motions after which the sheets of each patch lie best on one surface, and how much each
/// counts in the next round.
void improve(const SensorPatches& all, double radius, const Eigen::Vector3d& middle,
             std::vector<double>& weights, Eigen::VectorXd& motions) {
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(motions.size(), motions.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(motions.size());
  std::vector<double> difference(all.sheets.size());
  std::vector<Surface> heights;
  PatchEquations equations;
  for (const Patch& patch : all.patches) {
    const Eigen::Matrix<double, 3, 6> of_motion = terms_of_motion(patch, radius, middle);
    const auto at = [&](std::size_t i) { return 6 * all.sheets[patch.begin + i].sensor; };
    heights.clear();
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      const SensorPatch& s = all.sheets[i];
      heights.push_back(s.heights + s.gram.leftCols<3>() * (of_motion * motions.segment<6>(6 * s.sensor)));
    }
    equations.set(all, patch, heights, &weights[patch.begin]);
    for (std::size_t i = 0; i < heights.size(); ++i) {
      difference[patch.begin + i] = equations.difference(i);
      right.segment<6>(at(i)) += of_motion.transpose() * equations.right(i);
      for (std::size_t j = 0; j < heights.size(); ++j)
        squares.block<6, 6>(at(i), at(j)) += of_motion.transpose() * equations.squares(i, j) * of_motion;
    }
  }
  const double usual = std::max(kLastMotion, geometry::percentile(difference, 0.5));
  for (std::size_t i = 0; i < difference.size(); ++i)
    weights[i] = std::pow(1 + std::pow(difference[i] / (kOutlier * usual), 2), -2);
  const double prior = kMotionPrior * squares.trace() / static_cast<double>(motions.size());
  squares.diagonal().array() += prior;
  motions += squares.ldlt().solve(right - prior * motions);
}

/// Takes the points of sensors that share hardly anything with others for those of none; whether there were
/// any.
bool leave_out_loose(const SensorPatches& sheets, double radius, int sensors, std::vector<int>& sensor_of) {
  std::vector<int> patches(sensors, 0);
  for (const SensorPatch& sheet : sheets.sheets) ++patches[sheet.sensor];
  bool found = false;
  for (int& s : sensor_of) {
    if (s < 0 || patches[s] * radius * radius >= kLeastShared) continue;
    s = -1;
    found = true;
  }
  return found;
}

/// The motion of each sensor about `middle`, their mean zero; empty where there is nothing to compare.
/// Sensors that share too little with others are taken out of `sensor_of`.
std::vector<SmallMotion> motions_of(const Points& points, std::vector<int>& sensor_of, int sensors,
                                    const Eigen::Vector3d& middle) {
  const double radius =
      std::min(kLargest, kRadius * std::sqrt(std::max(1.0, kDense / static_cast<double>(points.size()))));
  SensorPatches sheets = sensor_patches_of(points, {}, sensor_of, sensors, radius, kStep);
  while (leave_out_loose(sheets, radius, sensors, sensor_of))  // once for each sensor at most
    sheets = sensor_patches_of(points, {}, sensor_of, sensors, radius, kStep);
  if (sheets.sheets.empty()) return {};
  std::vector<double> weights(sheets.sheets.size(), 1);
  Eigen::VectorXd motions = Eigen::VectorXd::Zero(6 * sensors);
  for (int round = 0; round < kRounds; ++round) improve(sheets, radius, middle, weights, motions);
  SmallMotion mean = SmallMotion::Zero();
  double count = 0;
  for (int s : sensor_of) {
    if (s < 0) continue;
    mean += motions.segment<6>(6 * s);
    ++count;
  }
  std::vector<SmallMotion> result(sensors);
  for (int s = 0; s < sensors; ++s) result[s] = motions.segment<6>(6 * s) - mean / count;
  return result;
}

/// Root mean square of the distances that the points of one sensor move, of that which moves most.
double largest_move(const Points& from, const Points& to, const std::vector<int>& sensor_of, int sensors) {
  std::vector<double> squares(sensors, 0), count(sensors, 0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (sensor_of[i] < 0) continue;
    squares[sensor_of[i]] += (to[i] - from[i]).squaredNorm();
    ++count[sensor_of[i]];
  }
  double largest = 0;
  for (int s = 0; s < sensors; ++s) largest = std::max(largest, squares[s] / std::max(count[s], 1.0));
  return std::sqrt(largest);
}

}  // namespace

void register_sensors(Points& points, std::vector<int> sensor_of) {
  const int sensors = sensor_of.empty() ? 0 : *std::max_element(sensor_of.begin(), sensor_of.end()) + 1;
  if (sensors < 2) return;
  const Eigen::Vector3d middle = geometry::mean_of(points);
  Points moved = points;
  std::vector<Eigen::Isometry3d> whole(sensors, Eigen::Isometry3d::Identity());
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<SmallMotion> motions = motions_of(moved, sensor_of, sensors, middle);
    if (motions.empty()) return;
    std::vector<Eigen::Isometry3d> move;
    for (int s = 0; s < sensors; ++s) {
      move.push_back(geometry::motion_about(middle, motions[s]));
      whole[s] = move[s] * whole[s];
      const double shift = (whole[s] * middle - middle).norm(),
                   turn = Eigen::AngleAxisd(whole[s].linear()).angle();
      if (!(shift < kMost && turn < kMost)) return;
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      if (sensor_of[i] >= 0) moved[i] = move[sensor_of[i]] * moved[i];
    if (pass == 0 && largest_move(points, moved, sensor_of, sensors) < kNegligible) return;
  }
  points = std::move(moved);
}

}  // namespace tensegric_fit::reconstruction
