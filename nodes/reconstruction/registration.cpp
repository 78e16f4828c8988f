#include "reconstruction/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/halves.hpp"
#include "reconstruction/percentile.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Motion = Eigen::Matrix<double, 6, 1>;  // shift, turn; about the points' mean

using Surface = Eigen::Matrix<double, 6, 1>;  // 1, x, y, xx, xy, yy
using Gram = Eigen::Matrix<double, 6, 6>;

constexpr double kRadius = 0.010;  // m, of a patch, at this many points
constexpr double kDense = 180000;
constexpr double kLargest = 0.025;  // m
constexpr int kStep = 3;            // from patch to patch
constexpr int kFewest = 4;          // points of a sensor in a patch
constexpr double kFlat = 0.1;       // least variance over the next
constexpr int kPasses = 2, kRounds = 4;
constexpr double kOutlier = 4.5;           // usual differences, at which a sheet counts a quarter
constexpr double kLeastDifference = 1e-5;  // m
constexpr double kPrior = 1e-3;            // of the usual weight, that holds a motion to zero
constexpr double kRidge = 1e-6;            // of a patch's surface
constexpr double kMost = 0.010;            // m and rad, of a motion
// m; sensors that a booth has registered itself differ by 0.1 to 0.3, and another registration betters
// nothing.
constexpr double kNegligible = 0.0004;

// Why not the way of the booth's assembler: it matches points by their normals, which a cloud of sensors that
// are off has not yet got; patches that several sensors see need none.

/// What one sensor sees of a patch of skin: sums over its points, x and y along the patch in units of its
/// radius.
struct Sheet {
  int patch, sensor;
  double count;
  Gram gram;                              // of the surface's terms
  Surface heights;                        // terms times height over the patch, m
  Eigen::Matrix<double, 3, 6> of_motion;  // what a motion adds to the first three terms
};

/// The sheets of the patches round the cells from `begin` to `end` that several sensors see, patch by patch.
std::vector<Sheet> sheets_of(const Points& points, const std::vector<int>& sensor_of, int sensors,
                             const Eigen::Vector3d& middle, const VoxelGrid& grid, double radius, int first,
                             int last) {
  std::vector<Sheet> sheets;
  std::vector<int> cells, near, count(sensors), sheet_of(sensors);
  for (int c = first; c < last; c += kStep) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = grid.begin(c); i < grid.end(c); ++i) centre += points[grid.order()[i]];
    centre /= grid.end(c) - grid.begin(c);
    grid.around(c, cells);
    near.clear();
    std::fill(count.begin(), count.end(), 0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (int cell : cells) {
      for (int i = grid.begin(cell); i < grid.end(cell); ++i) {
        const int p = grid.order()[i];
        const Eigen::Vector3d d = points[p] - centre;
        if (sensor_of[p] < 0 || d.squaredNorm() > radius * radius) continue;
        near.push_back(p);
        ++count[sensor_of[p]];
        sum += d;
        products += d * d.transpose();
      }
    }
    if (std::count_if(count.begin(), count.end(), [](int n) { return n >= kFewest; }) < 2) continue;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(products - sum * sum.transpose() / static_cast<double>(near.size()));
    if (axes.eigenvalues()[0] > kFlat * axes.eigenvalues()[1]) continue;
    const Eigen::Vector3d normal = axes.eigenvectors().col(0), x = axes.eigenvectors().col(1),
                          y = axes.eigenvectors().col(2);
    Eigen::Matrix<double, 3, 6> of_motion;
    of_motion << normal.transpose(), (centre - middle).cross(normal).transpose(), Eigen::RowVector3d::Zero(),
        radius * x.cross(normal).transpose(), Eigen::RowVector3d::Zero(),
        radius * y.cross(normal).transpose();
    for (int s = 0; s < sensors; ++s) {
      sheet_of[s] = -1;
      if (count[s] < kFewest) continue;
      sheet_of[s] = static_cast<int>(sheets.size());
      sheets.push_back({c, s, static_cast<double>(count[s]), Gram::Zero(), Surface::Zero(), of_motion});
    }
    for (int i : near) {
      if (sheet_of[sensor_of[i]] < 0) continue;
      const Eigen::Vector3d d = points[i] - centre;
      const double u = x.dot(d) / radius, v = y.dot(d) / radius;
      Surface terms;
      terms << 1, u, v, u * u, u * v, v * v;
      Sheet& sheet = sheets[sheet_of[sensor_of[i]]];
      sheet.gram += terms * terms.transpose();
      sheet.heights += normal.dot(d) * terms;
    }
  }
  return sheets;
}

/// Calls `use(begin, end)` for the sheets of each patch.
template <typename Use>
void for_patches(const std::vector<Sheet>& sheets, const Use& use) {
  for (std::size_t begin = 0, end; begin < sheets.size(); begin = end) {
    for (end = begin + 1; end < sheets.size() && sheets[end].patch == sheets[begin].patch;) ++end;
    use(begin, end);
  }
}

/// One round: the motions after which the sheets of each patch lie best on one surface, and how much each
/// counts in the next round.
void improve(const std::vector<Sheet>& sheets, std::vector<double>& weights, Eigen::VectorXd& motions) {
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(motions.size(), motions.size());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(motions.size());
  const auto heights = [&](const Sheet& s) -> Surface {
    return s.heights + s.gram.leftCols<3>() * (s.of_motion * motions.segment<6>(6 * s.sensor));
  };
  std::vector<double> difference(sheets.size());
  for_patches(sheets, [&](std::size_t begin, std::size_t end) {
    Gram gram = Gram::Zero();
    Surface sum = Surface::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      gram += weights[i] * sheets[i].gram;
      sum += weights[i] * heights(sheets[i]);
    }
    gram.diagonal().array() += kRidge * gram.trace();
    const Eigen::LLT<Gram> solver(gram);
    const Surface surface = solver.solve(sum);
    for (std::size_t i = begin; i < end; ++i) {
      const Sheet& a = sheets[i];
      const Surface left = heights(a) - a.gram * surface;
      difference[i] = std::abs(left[0]) / a.count;
      right.segment<6>(6 * a.sensor) -= weights[i] * a.of_motion.transpose() * left.head<3>();
      const Eigen::Matrix<double, 6, 3> solved = weights[i] * solver.solve(a.gram.leftCols<3>());
      for (std::size_t j = begin; j < end; ++j) {
        const Sheet& b = sheets[j];
        Eigen::Matrix3d of_terms = -weights[j] * b.gram.topRows<3>() * solved;
        if (i == j) of_terms += weights[i] * a.gram.topLeftCorner<3, 3>();
        squares.block<6, 6>(6 * b.sensor, 6 * a.sensor) += b.of_motion.transpose() * of_terms * a.of_motion;
      }
    }
  });
  const double usual = std::max(kLeastDifference, percentile(difference, 0.5));
  for (std::size_t i = 0; i < sheets.size(); ++i)
    weights[i] = std::pow(1 + std::pow(difference[i] / (kOutlier * usual), 2), -2);
  const double prior = kPrior * squares.trace() / static_cast<double>(motions.size());
  squares.diagonal().array() += prior;
  motions += squares.ldlt().solve(right - prior * motions);
}

/// The motion of each sensor about `middle`, their mean zero; empty where there is nothing to compare.
std::vector<Motion> motions_of(const Points& points, const std::vector<int>& sensor_of, int sensors,
                               const Eigen::Vector3d& middle) {
  const double radius =
      std::min(kLargest, kRadius * std::sqrt(std::max(1.0, kDense / static_cast<double>(points.size()))));
  const VoxelGrid grid(points, radius);
  std::array<std::vector<Sheet>, 2> of_half;
  geometry::in_halves(grid.cell_count(), [&](std::size_t begin, std::size_t end, int half) {
    of_half[half] = sheets_of(points, sensor_of, sensors, middle, grid, radius, static_cast<int>(begin),
                              static_cast<int>(end));
  });
  std::vector<Sheet> sheets = std::move(of_half[0]);
  sheets.insert(sheets.end(), of_half[1].begin(), of_half[1].end());
  if (sheets.empty()) return {};
  std::vector<double> weights(sheets.size(), 1);
  Eigen::VectorXd motions = Eigen::VectorXd::Zero(6 * sensors);
  for (int round = 0; round < kRounds; ++round) improve(sheets, weights, motions);
  Motion mean = Motion::Zero();
  double count = 0;
  for (int s : sensor_of) {
    if (s < 0) continue;
    mean += motions.segment<6>(6 * s);
    ++count;
  }
  std::vector<Motion> result(sensors);
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

void register_sensors(Points& points, const std::vector<int>& sensor_of) {
  const int sensors = sensor_of.empty() ? 0 : *std::max_element(sensor_of.begin(), sensor_of.end()) + 1;
  if (sensors < 2) return;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) middle += p;
  middle /= static_cast<double>(points.size());
  Points moved = points;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<Motion> motions = motions_of(moved, sensor_of, sensors, middle);
    std::vector<Eigen::Isometry3d> move;
    for (const Motion& motion : motions) {
      if (!(motion.head<3>().norm() < kMost && motion.tail<3>().norm() < kMost)) return;
      const double angle = motion.tail<3>().norm();
      const Eigen::Vector3d axis =
          angle > 0 ? Eigen::Vector3d(motion.tail<3>() / angle) : Eigen::Vector3d::UnitX();
      move.push_back(Eigen::Translation3d(middle + motion.head<3>()) * Eigen::AngleAxisd(angle, axis) *
                     Eigen::Translation3d(-middle));
    }
    if (move.empty()) return;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (sensor_of[i] >= 0) moved[i] = move[sensor_of[i]] * moved[i];
    if (pass == 0 && largest_move(points, moved, sensor_of, sensors) < kNegligible) return;
  }
  points = std::move(moved);
}

}  // namespace tensegric_fit::reconstruction
