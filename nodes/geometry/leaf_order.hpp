/// Points of a nanoflann kd-tree beside each other in memory where they are beside each other in space.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

/// Puts the points of a tree that is built into the order of its leaves, so that those of a leaf are read in
/// one go. Returns the index that each had: results of the tree count in the new order.
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
