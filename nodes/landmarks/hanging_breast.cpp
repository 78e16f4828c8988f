#include "landmarks/hanging_breast.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

// Webs are narrower than kWeb; a fold's lowest part is as wide as that kFoldToWeb above its lowest point.
constexpr double kWeb = 0.040, kFoldToWeb = 0.0036;  // m
constexpr double kFirst = 0.002, kHighest = 0.016;   // m above the fold found, where webs are looked for
constexpr double kApart = 0.001;                     // m, between sections
constexpr double kLeast = 0.002;                     // m; a web is not told apart from noise below
constexpr int kJoined = 3;                           // sections; one that is noisy does not tell
constexpr double kGirthToWidth = 4;                  // of a lobe on its web; a mere bulge has less than 2.5
constexpr double kSmallestGirth = 0.05, kLongest = 0.20;  // m, of a lobe; along the skin from its tip
constexpr double kBeside = 0.06;                          // m beside the bust point, where its lobe's tip is
constexpr double kMedial = 0.012;  // statures; nearer to the middle it is the other side's

// What parts a lobe from the section: how wide it is at its narrowest, and, from `first` points before its
// tip to `last` after it, the cut no wider than a web that takes off most.
struct Cut {
  double width = 1e9, girth = 0;
  int tip = -1, first = 0, last = 0;
};

Cut lobe_cut(const Outline& section, const Eigen::Vector3d& bust_point, Side side, double stature) {
  const std::vector<Eigen::Vector3d>& points = section.points;
  const int count = static_cast<int>(points.size());
  const double middle = (section.low.y() + section.high.y()) / 2;
  Cut cut;
  for (int i = 0; i < count; ++i) {
    if (kSign[side] * (points[i].y() - middle) < kMedial * stature ||
        std::abs(points[i].y() - bust_point.y()) > kBeside)
      continue;
    if (cut.tip < 0 || points[i].x() > points[cut.tip].x()) cut.tip = i;
  }
  if (cut.tip < 0) return cut;
  const auto at = [&](int steps) -> const Eigen::Vector3d& {
    return points[((cut.tip + steps) % count + count) % count];
  };
  std::vector<double> ahead{0}, behind{0};  // along the section from the tip
  for (int i = 1; i < count / 2 && ahead.back() < kLongest; ++i)
    ahead.push_back(ahead.back() + (at(i) - at(i - 1)).norm());
  for (int i = 1; i < count / 2 && behind.back() < kLongest; ++i)
    behind.push_back(behind.back() + (at(-i) - at(1 - i)).norm());
  for (int i = 1; i < static_cast<int>(behind.size()); ++i) {
    for (int j = 1; j < static_cast<int>(ahead.size()); ++j) {
      const double girth = ahead[j] + behind[i], width = (at(j) - at(-i)).norm();
      if (girth < kSmallestGirth || girth < kGirthToWidth * width) continue;
      cut.width = std::min(cut.width, width);
      if (width > kWeb || girth <= cut.girth) continue;
      cut.girth = girth;
      cut.first = i;
      cut.last = j;
    }
  }
  return cut;
}

}  // namespace

Outline without_hanging_breasts(const Outline& section, const std::array<Eigen::Vector3d, 2>& bust_points,
                                double stature) {
  Outline rest = section;
  for (const Side side : {kLeft, kRight}) {
    const Cut cut = lobe_cut(rest, bust_points[side], side, stature);
    if (cut.width > kWeb) continue;
    const int count = static_cast<int>(rest.points.size());
    std::vector<Eigen::Vector3d> kept;
    for (int i = cut.last; i <= count - cut.first; ++i) kept.push_back(rest.points[(cut.tip + i) % count]);
    if (kept.size() >= 3) rest = outline_of(std::move(kept));
  }
  return rest;
}

double fold_above_web(const BodyShape& body, const Trunk& trunk, double fold,
                      const Eigen::Vector3d& bust_point, Side side) {
  int joined = 0;
  for (double up = kFirst; up < kHighest; up += kApart) {
    const std::vector<Outline> sections = trunk.outlines_with_breasts_at(fold + up);
    if (sections.empty()) return 0;
    const bool free = std::any_of(sections.begin() + 1, sections.end(), [&](const Outline& breast) {
      return std::abs(breast.centroid.y() - bust_point.y()) < kBeside;
    });
    joined = free || lobe_cut(sections.front(), bust_point, side, body.stature).width < kWeb ? 0 : joined + 1;
    if (joined < kJoined) continue;
    const double above = up - (kJoined - 1) * kApart - kFoldToWeb;
    return above > kLeast ? above : 0;
  }
  return 0;  // a lobe all the way up is no web's
}

}  // namespace tensegric_fit::landmarks
