/// Which columns of a booth may see the same skin.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/point_cloud.hpp"

namespace tensegric_fit::assembler {

struct ColumnPairs {
  std::vector<std::pair<int, int>> pairs;  ///< of two columns, each in both orders
  std::size_t searches;                    ///< of each pair in a step, at most
};

/// Columns that are empty, or whose boxes are farther than `reach` (m) from each other, are no pair.
ColumnPairs column_pairs(const std::vector<geometry::PointCloud>& columns, double reach);

}  // namespace tensegric_fit::assembler
