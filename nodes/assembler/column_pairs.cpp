#include "assembler/column_pairs.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace tensegric_fit::assembler {
namespace {

constexpr std::size_t kSearchesOfAll = 60000;  // in a step; shared by all pairs
constexpr std::size_t kFewestSearches = 400;   // of a pair

}  // namespace

ColumnPairs column_pairs(const std::vector<geometry::PointCloud>& columns, double reach) {
  std::vector<Eigen::AlignedBox3d> boxes(columns.size());
  for (std::size_t c = 0; c < columns.size(); ++c)
    for (const Eigen::Vector3d& p : columns[c].points) boxes[c].extend(p);
  const double far = 1.01 * reach * reach;  // a little more: distances of points are rounded otherwise
  ColumnPairs result;
  std::size_t all = 0;
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = 0; b < columns.size(); ++b) {
      if (a == b || boxes[a].isEmpty() || boxes[b].isEmpty()) continue;
      ++all;
      if (boxes[a].squaredExteriorDistance(boxes[b]) <= far)
        result.pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
    }
  // Up to twelve columns have enough for all pairs, near or not: more for those that are near is no better.
  const std::size_t sharing = all * kFewestSearches <= kSearchesOfAll ? all : result.pairs.size();
  result.searches = std::max(kFewestSearches, kSearchesOfAll / std::max<std::size_t>(1, sharing));
  return result;
}

}  // namespace tensegric_fit::assembler
