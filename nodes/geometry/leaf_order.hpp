/// Memory layout of a nanoflann kd-tree: points close in space are stored close in memory.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

/// Reorders the points of a built tree by its leaves, so that each leaf's points are contiguous. Returns the
/// former index of each point; query results are indices in the new order.
template <typename Tree, typename Point>
std::vector<int> to_leaf_order(Tree& tree, std::vector<Point>& points) {
  const std::vector<int> order = tree.vAcc;
  std::vector<Point> ordered(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    ordered[i] = points[order[i]];
    tree.vAcc[i] = static_cast<int>(i);
  }
  points = std::move(ordered);
  return order;
}

}  // namespace tensegric_fit::geometry
