#include "reconstruction/standing.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace tensegric_fit::reconstruction {
namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

const double kLeastUp = std::cos(20 * M_PI / 180);
constexpr int kMostPivots = 200;
constexpr double kFeet = 0.12;  // m; of a body that leans by 15 degrees one foot is that much above the other
constexpr double kFar = 10;     // m, beyond every point
constexpr double kRim = 0.003;  // m above the lowest points of the soles, from where a point has little say
constexpr int kRounds = 30;
const double kLeastAgreement = std::cos(5 * M_PI / 180);  // of what all low points say with three of them
// Of the lowest points, these two; the ground is so many times their distance below the first, and kBelow
// more.
constexpr std::size_t kLow = 9, kNextLow = 39;
constexpr double kTimes = 1.25, kBelow = 0.0015;  // m

/// True where the origin lies in the triangle as seen from above.
bool covers_origin(const Triangle& t) {
  const auto side = [&](int i, int j) { return t[i].x() * t[j].y() - t[i].y() * t[j].x(); };
  const double a = side(0, 1), b = side(1, 2), c = side(2, 0);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

Eigen::Vector3d upward_normal(const Triangle& t) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  return n.z() < 0 ? Eigen::Vector3d(-n) : n;
}

/// Height above which all points but `rank` lie.
double low_height(std::vector<double>& heights, std::size_t rank) {
  rank = std::min(rank, heights.size() - 1);
  std::nth_element(heights.begin(), heights.begin() + rank, heights.end());
  return heights[rank];
}

/// Normal of the plane through the rims of the soles, from one that is nearly so: of all points that are low,
/// the lower the more.
Eigen::Vector3d normal_of_rims(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& nearly) {
  Eigen::Vector3d normal = nearly;
  double lowest = nearly.dot(points.front());
  for (const Eigen::Vector3d& p : points) lowest = std::min(lowest, nearly.dot(p));
  std::vector<Eigen::Vector3d> feet;
  std::copy_if(points.begin(), points.end(), std::back_inserter(feet),
               [&](const Eigen::Vector3d& p) { return nearly.dot(p) < lowest + kFeet; });
  std::vector<double> heights(feet.size());
  for (int round = 0; round < kRounds; ++round) {
    std::transform(feet.begin(), feet.end(), heights.begin(),
                   [&](const Eigen::Vector3d& p) { return normal.dot(p); });
    const double low = low_height(heights, kLow);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double weight = 0;
    for (const Eigen::Vector3d& p : feet) {
      const double above = normal.dot(p) - low;
      if (above > 5 * kRim) continue;
      const double w = std::exp(-std::max(above, 0.0) / kRim);
      sum += w * p;
      squares += w * p * p.transpose();
      weight += w;
    }
    const Eigen::Vector3d mean = sum / weight;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / weight - mean * mean.transpose());
    const Eigen::Vector3d next = axes.eigenvectors().col(0) * (axes.eigenvectors()(2, 0) < 0 ? -1 : 1);
    if (!(next.dot(nearly) > kLeastAgreement)) return nearly;
    normal = next;
  }
  return normal;
}

}  // namespace

Eigen::Isometry3d level(const Eigen::Vector3d& normal, double offset, const Eigen::Vector3d& middle) {
  const Eigen::Vector3d origin = middle + (offset - normal.dot(middle)) * normal;
  Eigen::Isometry3d result(Eigen::Quaterniond::FromTwoVectors(normal, Eigen::Vector3d::UnitZ()));
  result.translation() = -(result.linear() * origin);
  return result;
}

Eigen::Isometry3d resting_plane(const std::vector<Eigen::Vector3d>& points) {
  double lowest = points.front().z();
  for (const Eigen::Vector3d& p : points) lowest = std::min(lowest, p.z());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double count = 0;
  for (const Eigen::Vector3d& p : points) {
    if (p.z() > lowest + kFeet) continue;
    middle += p;
    ++count;
  }
  middle /= count;
  // A plane that starts high up on three far points comes down: the point farthest below it takes the place
  // of one corner, such that the triangle still covers the middle.
  Triangle t{Eigen::Vector3d(kFar, -kFar, kFar), Eigen::Vector3d(0, kFar, kFar),
             Eigen::Vector3d(-kFar, -kFar, kFar)};
  for (int pivot = 0; pivot < kMostPivots; ++pivot) {
    const Eigen::Vector3d normal = upward_normal(t);
    Eigen::Vector3d deepest = t[0];
    for (const Eigen::Vector3d& p : points)
      if (normal.dot(p - middle) < normal.dot(deepest)) deepest = p - middle;
    if (normal.dot(deepest) > normal.dot(t[0]) - 1e-9) break;
    int corner = 0;
    for (; corner < 2; ++corner) {
      Triangle next = t;
      next[corner] = deepest;
      if (covers_origin(next)) break;
    }
    t[corner] = deepest;
  }
  const Eigen::Vector3d facet = upward_normal(t);
  if (!(facet.z() > kLeastUp)) return level(Eigen::Vector3d::UnitZ(), lowest, middle);
  // Noise and a single rim's bulge tilt the facet, rounder toes the plane of all rims: half way errs least.
  const Eigen::Vector3d normal = (facet + normal_of_rims(points, facet)).normalized();
  double offset = normal.dot(points.front());
  for (const Eigen::Vector3d& p : points) offset = std::min(offset, normal.dot(p));
  return level(normal, offset, middle);
}

double ground_under(const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : points) heights.push_back(p.z());
  const double low = low_height(heights, kLow);
  return low - kTimes * (low_height(heights, kNextLow) - low) - kBelow;
}

}  // namespace tensegric_fit::reconstruction
