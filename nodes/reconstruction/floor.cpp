#include "reconstruction/floor.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kColumn = 0.03;  // m, side of a column
// m, over a column's lowest point: of a wall a quarter of it lies within kColumn, far less than most.
constexpr double kLooked = 4 * kColumn;
constexpr double kThickness = 0.008;   // m, half: noise and misregistration of a floor
constexpr double kSmallestArea = 0.1;  // m^2; less could be the underside of something that was scanned
constexpr int kTrials = 400;
// Tolerances: deviations of a floor's points that reach over it (1 in 30,000 does farther), and m.
constexpr double kDeviations = 4, kLeastReach = 0.004, kMostReach = 0.008;
const double kLeastUp = std::cos(20 * M_PI / 180);

/// The lowest points of columns, in the columns' order.
struct Lowest {
  Points all;  ///< of every column that holds points
  /// Of those whose points hardly go on upwards, as a wall's do; a body or a ceiling stands clear of its
  /// floor.
  Points flat;
};

Lowest lowest_of_columns(const Points& points) {
  struct Entry {
    std::int64_t x, y;
    double z;
    int point;
    bool operator<(const Entry& o) const {
      return std::tie(x, y, z, point) < std::tie(o.x, o.y, o.z, o.point);
    }
  };
  std::vector<Entry> entries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& p = points[i];
    entries[i] = {static_cast<std::int64_t>(std::floor(p.x() / kColumn)),
                  static_cast<std::int64_t>(std::floor(p.y() / kColumn)), p.z(), static_cast<int>(i)};
  }
  std::sort(entries.begin(), entries.end());
  Lowest lowest;
  for (std::size_t i = 0, end = 0; i < entries.size(); i = end) {
    std::size_t low = 0, near = 0;
    for (; end < entries.size() && entries[end].x == entries[i].x && entries[end].y == entries[i].y; ++end) {
      if (entries[end].z < entries[i].z + kColumn) ++low;
      if (entries[end].z < entries[i].z + kLooked) ++near;
    }
    lowest.all.push_back(points[entries[i].point]);
    if (2 * low >= near) lowest.flat.push_back(lowest.all.back());
  }
  return lowest;
}

int count_within(const Points& points, const Eigen::Vector3d& normal, double offset) {
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3d& p) {
    return std::abs(normal.dot(p) - offset) < kThickness;
  }));
}

/// Best of planes through three columns each, by the number of columns that agree.
std::optional<Floor> sample_plane(const Points& lowest) {
  if (lowest.size() < 3) return std::nullopt;
  std::mt19937 random(1);  // fixed seed: same scan, same floor
  const auto pick = [&] { return lowest[random() % lowest.size()]; };
  std::optional<Floor> best;
  int most = 2;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d a = pick(), b = pick(), c = pick();
    Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 0.01) continue;  // nearly on one line, or close together
    normal.normalize();
    if (normal.z() < 0) normal = -normal;
    if (normal.z() < kLeastUp) continue;
    const double offset = normal.dot(a);
    const int count = count_within(lowest, normal, offset);
    if (count <= most) continue;
    most = count;
    best = Floor{normal, offset, 0};
  }
  return best;
}

/// Least squares over all points near the plane.
void refine(const Points& points, Floor& floor) {
  for (int round = 0; round < 3; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double count = 0;
    const auto on_floor = [&](const Eigen::Vector3d& p) {
      return std::abs(floor.normal.dot(p) - floor.offset) < kThickness;
    };
    for (const Eigen::Vector3d& p : points) {
      if (!on_floor(p)) continue;
      mean += p;
      ++count;
    }
    mean /= count;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& p : points)
      if (on_floor(p)) covariance += (p - mean) * (p - mean).transpose() / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
    floor.normal = axes.eigenvectors().col(0) * (axes.eigenvectors()(2, 0) < 0 ? -1 : 1);
    floor.offset = floor.normal.dot(mean);
    floor.noise = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
  }
}

}  // namespace

double reach_of_floor(double noise) {
  return std::clamp(kDeviations * noise, kLeastReach, kMostReach);
}

std::optional<Floor> find_floor(const Points& points) {
  const Lowest lowest = lowest_of_columns(points);
  std::optional<Floor> floor = sample_plane(lowest.flat);
  if (!floor) return std::nullopt;
  const int columns = count_within(lowest.flat, floor->normal, floor->offset);
  const auto below = std::count_if(lowest.all.begin(), lowest.all.end(), [&](const Eigen::Vector3d& p) {
    return floor->normal.dot(p) < floor->offset - 2 * kThickness;
  });
  if (columns * kColumn * kColumn < kSmallestArea || below > 0.2 * columns) return std::nullopt;
  refine(points, *floor);
  return floor;
}

}  // namespace tensegric_fit::reconstruction
