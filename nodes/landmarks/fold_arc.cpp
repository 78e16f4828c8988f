#include "landmarks/fold_arc.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

// On scans of known folds what is found from 100 degrees on is the fold, at 85 it lies 5 mm too low, at 70
// and less 10 to 15 mm.
constexpr double kHides = 90 * kDegree, kSeen = 105 * kDegree;
constexpr double kFaint = 40;    // 1/m; at sternum and flank the fold runs out
constexpr double kTurn = 0.006;  // m; a fold that falls again by more, away from its lowest point, is none
constexpr double kOuter = 0.025, kInner = 0.045;  // m medial; the arc is held at both ends
// Places seen at each end that hold the arc; outside one alone does not, as the flank is near.
constexpr double kHeldOuter = 1.2, kHeldInner = 0.75;
constexpr double kNoise = 0.0025, kPocket = 0.008;  // m, by which places seen and hidden leave the arc
// 1/m: a fold rises by so much times the square of the distance from its lowest point; how far folds differ.
constexpr double kCurve = 8.8, kCurveSpread = 4.8;
// Places that this counts for: in all, and where those seen at both ends tell the curve.
constexpr double kCurveWeight = 1.4, kCurveWeightHeld = 0.3;
constexpr double kAstray = 0.004;  // m off the arc, from where a place counts for less than half
constexpr double kLeast = 0.002, kDeepest = 0.030;  // m; less is noise
constexpr int kRounds = 25;

bool within(const FoldPlace& place, double reach) {
  return place.medial > -1e-9 && place.medial < reach + 1e-9;
}

std::vector<FoldPlace> known(std::vector<FoldPlace> way) {
  const auto unknown = [](const FoldPlace& place) { return place.opening < 0; };
  way.erase(std::remove_if(way.begin(), way.end(), unknown), way.end());
  return way;
}

// Those places that are one fold: from its lowest point within reach it rises to both sides.
std::vector<FoldPlace> one_fold(const std::vector<FoldPlace>& way, double reach) {
  const int count = static_cast<int>(way.size());
  int lowest = -1;
  for (int i = 0; i < count; ++i)
    if (within(way[i], reach) && (lowest < 0 || way[i].height < way[lowest].height)) lowest = i;
  if (lowest < 0) return {};
  const auto end_of_rise = [&](int step) {
    double highest = way[lowest].height;
    int i = lowest;
    while (i + step >= 0 && i + step < count && way[i + step].hollowness >= kFaint &&
           way[i + step].height >= highest - kTurn) {
      i += step;
      highest = std::max(highest, way[i].height);
    }
    return i;
  };
  return {way.begin() + end_of_rise(-1), way.begin() + end_of_rise(1) + 1};
}

// Height = c0 + c1 medial + c2 medial^2, by weighted least squares.
Eigen::Vector3d fit_arc(const std::vector<FoldPlace>& places, const std::vector<double>& weights,
                        double curve_weight) {
  const double prior = curve_weight * std::pow(kNoise / kCurveSpread, 2);
  Eigen::Matrix3d normal = Eigen::Vector3d(0, 0, prior).asDiagonal();
  Eigen::Vector3d right(0, 0, prior * kCurve);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Eigen::Vector3d terms(1, places[i].medial, places[i].medial * places[i].medial);
    normal += weights[i] * terms * terms.transpose();
    right += weights[i] * places[i].height * terms;
  }
  return normal.ldlt().solve(right);
}

double height_of(const Eigen::Vector3d& arc, double medial) {
  return arc[0] + arc[1] * medial + arc[2] * medial * medial;
}

}  // namespace

double lowest_of_arc(const std::vector<FoldPlace>& fold, double reach) {
  std::vector<double> weights(fold.size(), 1.0);
  Eigen::Vector3d arc = Eigen::Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    arc = fit_arc(fold, weights, kCurveWeight);
    for (std::size_t i = 0; i < fold.size(); ++i)
      weights[i] = 1 / (1 + std::pow((fold[i].height - height_of(arc, fold[i].medial)) / kAstray, 2));
  }
  const double first = std::max(0.0, fold.front().medial);
  const double last = std::max(first, std::min(reach, fold.back().medial));
  const double bottom = arc[2] > 0 ? std::clamp(-arc[1] / (2 * arc[2]), first, last) : first;
  return std::min({height_of(arc, first), height_of(arc, bottom), height_of(arc, last)});
}

double fold_above_pocket(const std::vector<FoldPlace>& way, double lowest, double reach) {
  const std::vector<FoldPlace> fold = one_fold(known(way), reach);
  std::vector<double> seen;
  double outer = 0, inner = 0;
  for (const FoldPlace& place : fold) {
    seen.push_back(std::clamp((place.opening - kHides) / (kSeen - kHides), 0.0, 1.0));
    if (place.medial < kOuter) outer += seen.back();
    if (place.medial > kInner) inner += seen.back();
  }
  if (outer < kHeldOuter || inner < kHeldInner) return 0;

  std::vector<double> weights = seen;
  Eigen::Vector3d arc = Eigen::Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    arc = fit_arc(fold, weights, kCurveWeightHeld);
    for (std::size_t i = 0; i < fold.size(); ++i) {
      const double above = fold[i].height - height_of(arc, fold[i].medial);
      weights[i] = seen[i] / (1 + std::pow(above / kNoise, 2));
      // What spans a pocket lies below the fold, never above it.
      if (above > 0) weights[i] += (1 - seen[i]) / (1 + std::pow(above / kPocket, 2));
    }
  }
  const double bottom = arc[2] > 0 ? std::clamp(-arc[1] / (2 * arc[2]), 0.0, reach) : 0;
  const double raised = height_of(arc, bottom) - lowest;
  return raised < kLeast ? 0 : std::min(raised, kDeepest);
}

bool lies_in_pocket(const std::vector<FoldPlace>& way, double reach) {
  std::vector<double> openings;
  for (const FoldPlace& place : known(way))
    if (within(place, reach)) openings.push_back(place.opening);
  if (openings.empty()) return false;
  const auto middle = openings.begin() + static_cast<std::ptrdiff_t>(openings.size() / 2);
  std::nth_element(openings.begin(), middle, openings.end());
  return *middle < kHides;
}

}  // namespace tensegric_fit::landmarks
