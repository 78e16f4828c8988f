#include "virtual_body/skin_measures.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/parabola.hpp"
#include "virtual_body/doubts.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

constexpr double kTapeBelowFold = 0.003;                                       // m
constexpr double kAboveHip = 0.100, kBelowUnderbust = 0.015;                   // m: the waist is in between
constexpr double kLevels = 0.0025, kWaistReach = 0.0176, kWaistMoved = 0.006;  // m
constexpr double kWaistSmoothing = 2;                 // levels: deviation of a Gaussian
constexpr int kEnd = 3;                               // levels: a least girth so near to an end is the end's
constexpr double kNeckUp = 0.040, kNeckStep = 0.005;  // m
constexpr double kWhole = 0.5;                        // of the base's girth: less is no loop round a neck
constexpr double kArmBelowAxilla = 0.087, kThighBelowCrotch = 0.066;  // m at a stature of 1.70 m
constexpr double kCoarseLevels = 0.005, kAboveBust = 0.040;           // m

/// From low to high.
std::vector<double> levels(double low, double high, double step) {
  std::vector<double> result;
  for (int i = 0; low + i * step <= high + 1e-9; ++i) result.push_back(low + i * step);
  return result;
}

/// The ends mirrored.
std::vector<double> smoothed(const std::vector<double>& values) {
  const int reach = static_cast<int>(4 * kWaistSmoothing), count = static_cast<int>(values.size());
  std::vector<double> result(values.size(), 0);
  for (int i = 0; i < count; ++i) {
    double sum = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double w = std::exp(-0.5 * k * k / (kWaistSmoothing * kWaistSmoothing));
      int j = i + k;
      if (j < 0) j = -1 - j;
      if (j >= count) j = 2 * count - 1 - j;
      result[i] += w * values[std::clamp(j, 0, count - 1)];
      sum += w;
    }
    result[i] /= sum;
  }
  return result;
}

/// The level where the torso's tape has an inner minimum.
struct Waist {
  double height;
  double flat;   ///< m of levels on which the tape is within 1 mm of its least
  double depth;  ///< m, of the minimum below the lower of the two highest tapes to its sides
};

std::optional<Waist> find_waist(const Skin& skin, double low, double high) {
  const std::vector<double> z = levels(low, high, kLevels);
  if (static_cast<int>(z.size()) <= 2 * kEnd + 2) return std::nullopt;
  std::vector<double> girths;
  for (const double level : z) girths.push_back(girth(skin.round_torso(level)));
  girths = smoothed(girths);
  const auto least = std::min_element(girths.begin(), girths.end());
  const int at = static_cast<int>(least - girths.begin()), count = static_cast<int>(z.size());
  if (at < kEnd || at >= count - kEnd) return std::nullopt;
  geometry::Parabola parabola;
  double flat_low = z[at], flat_high = z[at];
  for (int i = 0; i < count; ++i) {
    if (girths[i] < *least + 0.001) {
      flat_low = std::min(flat_low, z[i]);
      flat_high = std::max(flat_high, z[i]);
    }
    const double d = (z[i] - z[at]) / kWaistReach;
    if (std::abs(d) < 1) parabola.add(d, girths[i]);
  }
  const Vector3d c = parabola.coefficients();
  const double up = c[2] > 0 ? -c[1] / (2 * c[2]) * kWaistReach : 0;
  const double below = *std::max_element(girths.begin(), least),
               above = *std::max_element(least + 1, girths.end());
  return Waist{z[at] + std::clamp(up, -kWaistMoved, kWaistMoved), flat_high - flat_low,
               std::min(below, above) - *least};
}

double height_of_largest(const Skin& skin, double low, double high) {
  double best = low, most = 0;
  for (const double z : levels(low, high, kCoarseLevels)) {
    const double here = girth(skin.round_trunk(z));
    if (here <= most) continue;
    most = here;
    best = z;
  }
  return best;
}

Tape least_round_neck(const Skin& skin, const Ray& neck) {
  Tape best;
  double base = 0;
  for (const double up : levels(0, kNeckUp, kNeckStep)) {
    Tape tape = skin.round_nearest(neck.origin + up * neck.direction, neck.direction, Part::whole);
    if (up == 0) base = girth(tape);
    if (girth(tape) > kWhole * base && (best.empty() || girth(tape) < girth(best))) best = std::move(tape);
  }
  return best;
}

}  // namespace

void measure_skin(const Skin& skin, const BodyAxes& axes, VirtualBody& body) {
  geometry::BodyMeasures& truth = body.truth;
  const auto height = [&truth](const std::string& name, double metres) {
    truth.heights.push_back({name, metres, 1.0, ""});
    return metres;
  };
  const auto girth_of = [&truth](const std::string& name, const Tape& tape) {
    truth.girths.push_back({name, girth(tape), 1.0, ""});
    truth.loops.push_back({name, tape});
  };
  const auto z_of = [&truth](const std::string& name) { return truth.landmark(name).z(); };

  const double bust = height("bust", (z_of("bust_point_L") + z_of("bust_point_R")) / 2);
  const double underbust = height("underbust", std::min(z_of("fold_lowest_L"), z_of("fold_lowest_R")));
  const Buttock left = find_buttock(skin, truth.landmark("buttock_L")),
                right = find_buttock(skin, truth.landmark("buttock_R"));
  const double hip = height("hip", (left.apex.z() + right.apex.z()) / 2);
  const double crotch = height("crotch", z_of("crotch"));
  const std::optional<Waist> narrowest = find_waist(skin, hip + kAboveHip, underbust - kBelowUnderbust);
  const double ruler = height("waist_ruler", z_of("navel"));
  const double waist = height("waist", narrowest ? narrowest->height : ruler);
  body.waist_method = narrowest ? "interior minimum of the hull girth" : "no interior minimum: ruler level";
  const double hip_max = height("hip_max_girth", height_of_largest(skin, crotch, waist));
  const double bust_max = height("bust_max", height_of_largest(skin, underbust, bust + kAboveBust));
  height("neck", axes.neck.origin.z());
  height("stature", geometry::bounding_box(skin.mesh().vertices)[1].z());

  girth_of("bust", skin.round_trunk(bust));
  girth_of("bust_max", skin.round_trunk(bust_max));
  girth_of("underbust", skin.round_torso(underbust - kTapeBelowFold));
  girth_of("waist", skin.round_torso(waist));
  girth_of("waist_ruler", skin.round_torso(ruler));
  girth_of("hip", skin.round_trunk(hip));
  girth_of("hip_max", skin.round_trunk(hip_max));
  girth_of("neck", least_round_neck(skin, axes.neck));
  for (const Side side : kSides) {
    const Ray &arm = axes.upper_arms[side], &thigh = axes.thighs[side];
    const double axilla =
        (truth.landmark(std::string("axilla") + kSuffix[side]) - arm.origin).dot(arm.direction);
    girth_of(std::string("upper_arm") + kSuffix[side],
             skin.round_nearest(arm.origin + (axilla + axes.scale * kArmBelowAxilla) * arm.direction,
                                arm.direction, Part::arms));
    const double along = (crotch - axes.scale * kThighBelowCrotch - thigh.origin.z()) / thigh.direction.z();
    girth_of(std::string("thigh") + kSuffix[side],
             skin.round_nearest(thigh.origin + along * thigh.direction, thigh.direction, Part::trunk));
  }

  if (!narrowest || narrowest->depth < 0.001) body.doubts.vague.push_back("girth waist");
  if (!narrowest || narrowest->depth < 0.003 || narrowest->flat > 0.030)
    body.doubts.vague.push_back("height waist");
  if (std::max(left.flat, right.flat) > 0.028) body.doubts.vague.push_back("height hip");
  doubt_folds(skin, body);
  doubt_crotch(skin, body);
  for (const Side side : kSides) doubt_shoulder(skin, axes.upper_arms[side], side, body);
}

}  // namespace tensegric_fit::virtual_body
