#include "landmarks/fold_arc.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

constexpr double kHides = 90 * 3.14159265358979323846 / 180;  // an opening that sensors hardly see into
constexpr double kNoise = 0.0025;                             // m, by which places leave the arc
// 1/m: a fold rises by so much times the square of the distance from its lowest point; how far folds differ.
constexpr double kCurve = 8.8, kCurveSpread = 4.8;
constexpr double kCurveWeight = 1.4;  // places that this counts for
constexpr double kAstray = 0.004;     // m off the arc, from where a place counts for less than half
constexpr int kRounds = 25;

bool within(const FoldPlace& place, double reach) {
  return place.medial > -1e-9 && place.medial < reach + 1e-9;
}

std::vector<FoldPlace> known(std::vector<FoldPlace> way) {
  const auto unknown = [](const FoldPlace& place) { return place.opening < 0; };
  way.erase(std::remove_if(way.begin(), way.end(), unknown), way.end());
  return way;
}

// Height = c0 + c1 medial + c2 medial^2, by weighted least squares.
Eigen::Vector3d fit_arc(const std::vector<FoldPlace>& places, const std::vector<double>& weights) {
  const double prior = kCurveWeight * std::pow(kNoise / kCurveSpread, 2);
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
    arc = fit_arc(fold, weights);
    for (std::size_t i = 0; i < fold.size(); ++i)
      weights[i] = 1 / (1 + std::pow((fold[i].height - height_of(arc, fold[i].medial)) / kAstray, 2));
  }
  const double first = std::max(0.0, fold.front().medial);
  const double last = std::max(first, std::min(reach, fold.back().medial));
  const double bottom = arc[2] > 0 ? std::clamp(-arc[1] / (2 * arc[2]), first, last) : first;
  return std::min({height_of(arc, first), height_of(arc, bottom), height_of(arc, last)});
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
