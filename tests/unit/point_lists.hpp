/// Lists of points beside each other, for tests.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstring>
#include <vector>

namespace tensegric_fit {

inline bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0;
}

inline bool same_bits(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& p, const auto& q) { return same_bits(p, q); });
}

inline bool is_finite(const std::vector<Eigen::Vector3d>& points) {
  return std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); });
}

/// The largest distance of a point from its counterpart. \pre equally many
inline double farthest(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) distance = std::max(distance, (a[i] - b[i]).norm());
  return distance;
}

}  // namespace tensegric_fit
