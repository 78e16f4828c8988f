#include "landmarks/junction.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

constexpr int kPlaces = 13;  // lateral positions tried
// Of a limb's depth so much is one with the trunk at its root; fillings are shorter.
constexpr double kShareOfLimb = 0.5;
constexpr double kApart = 0.0025;       // between sections
constexpr int kReach = 2;               // sections each way over which lengthening is taken: 5 mm
constexpr int kGrown = 4;               // sections above, 10 mm, where the bridge must have that share
constexpr double kGrownTogether = 0.9;  // share of the length further up

}  // namespace

Bridge narrowest_bridge(const std::vector<Outline>& outlines, double low_y, double high_y) {
  Bridge narrowest;
  for (int k = 0; k < kPlaces; ++k) {
    const double y = low_y + (high_y - low_y) * k / (kPlaces - 1);
    std::vector<double> crossings;
    for (const Outline& outline : outlines) {
      for (std::size_t i = 0; i < outline.points.size(); ++i) {
        const Eigen::Vector3d &a = outline.points[i], &b = outline.points[(i + 1) % outline.points.size()];
        if ((a.y() > y) != (b.y() > y))
          crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
      }
    }
    if (crossings.size() < 2) return {0, y, 0, 0};
    std::sort(crossings.begin(), crossings.end());
    double length = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) length += crossings[i + 1] - crossings[i];
    if (k == 0 || length < narrowest.length) narrowest = {length, y, crossings.front(), crossings.back()};
  }
  return narrowest;
}

Junction find_junction(const SlicedMesh& body, const JunctionSearch& search) {
  std::vector<double> heights;
  std::vector<Bridge> bridges;
  for (double z = search.low; z <= search.high; z += kApart) {
    heights.push_back(z);
    bridges.push_back(narrowest_bridge(body.outlines_at(z), search.low_y, search.high_y));
  }
  Junction junction{search.low, {}};
  double most = 0;
  for (int i = kReach; i + kGrown < static_cast<int>(bridges.size()); ++i) {
    const double before = bridges[i - kReach].length, after = bridges[i + kReach].length;
    if (after - before <= most || bridges[i + kGrown].length < kShareOfLimb * search.limb_depth) continue;
    most = after - before;
    int crossing = i - kReach;  // where it is half way from the one to the other
    while (bridges[crossing + 1].length < (before + after) / 2) ++crossing;
    const double share = ((before + after) / 2 - bridges[crossing].length) /
                         std::max(bridges[crossing + 1].length - bridges[crossing].length, 1e-9);
    junction = {heights[crossing] + std::clamp(share, 0.0, 1.0) * kApart, bridges[i + kReach]};
  }
  return junction;
}

Root find_root(const SlicedMesh& body, const JunctionSearch& search, double further_up) {
  std::vector<double> lengths;
  for (double z = search.low; z <= search.high + further_up; z += kApart)
    lengths.push_back(narrowest_bridge(body.outlines_at(z), search.low_y, search.high_y).length);
  const int up = static_cast<int>(std::lround(further_up / kApart));
  // The highest place below which the share is missing: lower down, fillings come and go.
  const auto missing = [&](int i) { return kGrownTogether * lengths[i + up] - lengths[i]; };
  for (int i = static_cast<int>(lengths.size()) - up - 2; i >= 0; --i)
    if (missing(i) > 0 && missing(i + 1) <= 0)
      return {true, search.low + (i + missing(i) / (missing(i) - missing(i + 1))) * kApart};
  return {};
}

}  // namespace tensegric_fit::landmarks
