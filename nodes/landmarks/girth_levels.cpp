#include "landmarks/girth_levels.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

constexpr double kApart = 0.0025;
constexpr int kEnd = 3;  // levels, 7.5 mm; a least girth this near the end of the search is the end's
constexpr double kNoise = 0.0005;  // m, of a girth
// Levels each way, 20 mm, over which a cubic takes the noise out of the minimum; a parabola puts it 2 mm too
// high, since the trunk widens faster downwards.
constexpr int kFit = 8;
constexpr double kLead = 0.005;  // m; five tapes tell how the girth changes upwards
constexpr double kOnward = 0.7;  // of that change goes on: towards the breasts the trunk slims less and less

}  // namespace

std::vector<Eigen::Vector3d> tape_carried_up(const std::function<std::vector<Outline>(double)>& outline_at,
                                             double seen, double height) {
  std::vector<Eigen::Vector3d> tape = tape_loop(outline_at(seen));
  if (tape.size() < 3) return {};
  double slope = 0;  // least squares over -2 to 2 steps
  for (int i = -2; i <= 2; ++i) {
    const std::vector<Outline> outline = outline_at(seen + (i - 2) * kLead);
    if (outline.empty()) return {};
    slope += i * tape_length(outline) / (10 * kLead);
  }
  const double length = geometry::length_of(tape, true);
  const double scale = std::max(1 + kOnward * slope * (height - seen) / length, 0.5);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : tape) middle += p / static_cast<double>(tape.size());
  for (Eigen::Vector3d& p : tape) {
    p = middle + scale * (p - middle);
    p.z() = height;
  }
  return tape;
}

double navel_height(const BodyShape& body) {
  // Women's navel: 0.60 to 0.62 of stature, 0.14 of stature above the crotch; each errs with the proportion
  // of the legs.
  return (0.608 * body.stature + body.crotch.height + 0.14 * body.stature) / 2;
}

WaistLevel find_waist(const BodyShape& body, const Trunk& trunk, double lowest, double highest) {
  std::vector<double> heights, girths;
  for (double z = lowest; z <= highest; z += kApart) {
    const std::vector<Outline> outline = trunk.outline_at(z);
    if (outline.empty()) continue;
    heights.push_back(z);
    girths.push_back(tape_length(outline));
  }
  const WaistLevel by_proportion{
      navel_height(body), 0.4,
      "the girth has no minimum between hips and bust; level of the navel by proportion"};
  const int count = static_cast<int>(girths.size());
  if (count < 2 * kFit) return by_proportion;
  // Inner: on both sides the girth grows again, by more than the noise. Of several such levels the least; a
  // thick waist can be wider than the rib cage at the end of the search.
  int least = -1;
  for (int i = kEnd; i < count - kEnd; ++i) {
    const double below = *std::max_element(girths.begin(), girths.begin() + i);
    const double above = *std::max_element(girths.begin() + i, girths.end());
    const bool local =
        girths[i] <= *std::min_element(girths.begin() + i - kEnd, girths.begin() + i + kEnd + 1);
    if (local && std::min(below, above) > girths[i] + kNoise && (least < 0 || girths[i] < girths[least]))
      least = i;
  }
  if (least < 0) return by_proportion;

  const int first = std::max(0, least - kFit), last = std::min(count - 1, least + kFit);
  Eigen::MatrixXd terms(last - first + 1, 4);
  Eigen::VectorXd values(last - first + 1);
  for (int i = first; i <= last; ++i) {
    const double d = heights[i] - heights[least];
    terms.row(i - first) << 1, d, d * d, d * d * d;
    values[i - first] = girths[i];
  }
  const Eigen::Vector4d c = terms.colPivHouseholderQr().solve(values);
  // Where the cubic's slope is nought and grows.
  const double root = c[2] * c[2] - 3 * c[1] * c[3];
  const double shift = c[2] > 0 && root > 0 ? -c[1] / (c[2] + std::sqrt(root)) : 0;
  return {heights[least] + std::clamp(shift, -kFit * kApart, kFit * kApart), 0.9, ""};
}

}  // namespace tensegric_fit::landmarks
