#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

constexpr double kMedial = 0.055;           // m inwards of the bust point (definition)
constexpr double kSectionSpacing = 0.0025;  // m between two profiles
constexpr double kRim = 0.020;              // m along the skin: the areola's own rim is hollow too
constexpr double kReach = 0.17;             // m along the skin, from a bust point to its fold
constexpr double kPull = 15;                // 1/m of curvature that a place loses at the search's end
constexpr double kStep = 0.012;      // m that a fold rises or falls from one profile to the next, at most
constexpr double kContinued = 0.3;   // of its curvature below the bust point: less is no fold any more
constexpr double kFoldBottom = 0.6;  // of the curvature: skin that is as hollow takes part in the place
constexpr double kOutlier = 0.004;   // m off the arc, where a place counts for half

/// The most hollow place of a profile: the middle of the skin that is nearly as hollow; nothing where there
/// is none.
struct Hollow {
  Vector3d place;
  double curvature;
};
std::optional<Hollow> most_hollow(const Profile& profile, const Vector3d& expected, double reach) {
  const int first = static_cast<int>(kRim / Profile::kStep),
            last = std::min(static_cast<int>(profile.points.size()) - 2,
                            static_cast<int>(kReach / Profile::kStep));
  std::vector<double> value(profile.points.size(), -1e9);
  int best = -1;
  for (int i = first; i < last; ++i) {
    const Vector3d off = profile.points[i] - expected;
    const double far = std::hypot(off.x(), off.z()) / reach;
    if (far < 1) value[i] = profile.curvature[i] - kPull * far * far;
    if (value[i] > -1e8 && (best < 0 || value[i] > value[best])) best = i;
  }
  if (best < 0 || profile.curvature[best] <= 0) return std::nullopt;
  Vector3d sum = Vector3d::Zero();
  double weight = 0;
  const double floor = kFoldBottom * profile.curvature[best];
  for (const int step : {-1, 1})
    for (int i = step < 0 ? best : best + 1; i >= first && i < last && profile.curvature[i] > floor;
         i += step) {
      sum += (profile.curvature[i] - floor) * profile.points[i];
      weight += profile.curvature[i] - floor;
    }
  return Hollow{weight > 0 ? Vector3d(sum / weight) : profile.points[best], profile.curvature[best]};
}

/// Lowest point of a parabola through the places over their distance inwards, those off it counting less.
Vector3d lowest_of_arc(const std::vector<Vector3d>& places, Side side) {
  const int count = static_cast<int>(places.size());
  if (count < 4)
    return *std::min_element(places.begin(), places.end(),
                             [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
  Eigen::VectorXd inwards(count), z(count), weight = Eigen::VectorXd::Ones(count);
  for (int i = 0; i < count; ++i) {
    inwards[i] = -kSign[side] * (places[i].y() - places[0].y()) / kMedial;
    z[i] = places[i].z();
  }
  Eigen::MatrixXd terms(count, 3);
  terms << Eigen::VectorXd::Ones(count), inwards, inwards.cwiseAbs2();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int round = 0; round < 5; ++round) {
    c = (terms.transpose() * weight.asDiagonal() * terms)
            .ldlt()
            .solve(terms.transpose() * weight.asDiagonal() * z);
    const Eigen::VectorXd off = z - terms * c;
    weight = 1 / (1 + (off.array() / kOutlier).square());
  }
  int lowest = 0;
  const Eigen::VectorXd arc = terms * c;
  arc.minCoeff(&lowest);
  return {places[lowest].x(), places[lowest].y(), arc[lowest]};
}

}  // namespace

Fold find_fold(const Trunk& trunk, const Vector3d& bust_point, Side side,
               const std::vector<Vector3d>& expected, double reach) {
  Fold fold;
  double first = 0;  // 1/m, the curvature below the bust point
  for (double medial = 0; medial < kMedial + kSectionSpacing / 2; medial += kSectionSpacing) {
    const std::size_t i = fold.places.size();
    if (i >= expected.size() && expected.size() != 1) break;
    const Profile profile =
        profile_down(trunk, bust_point - kSign[side] * medial * Vector3d::UnitY(), kReach + 0.08);
    const auto found = most_hollow(profile, i < expected.size() ? expected[i] : fold.places.back(), reach);
    if (!found) break;
    if (fold.places.empty()) {
      first = found->curvature;
    } else if (found->curvature < kContinued * first ||
               std::abs(found->place.z() - fold.places.back().z()) > kStep) {
      break;
    }
    fold.places.push_back(found->place);
  }
  if (!fold.places.empty()) fold.lowest = lowest_of_arc(fold.places, side);
  return fold;
}

}  // namespace tensegric_fit::landmarks
