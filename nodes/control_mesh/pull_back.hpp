/// Nodes that were moved too far go back.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace tensegric_fit::control_mesh {

/// In folds nodes soon lie on the other side, or cross each other. The nodes that `mark_turned(marks)` marks,
/// those of triangles that lie badly where the nodes are now, go back to where they were `before`: halfway in
/// the first `halvings` rounds, then all the way, until none is marked or `rounds` are over. All of a round
/// go at once, so that no order shows.
template <typename MarkTurned>
void pull_back(std::vector<Eigen::Vector3d>& nodes, const std::vector<Eigen::Vector3d>& before, int halvings,
               int rounds, const MarkTurned& mark_turned) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<char> turned(nodes.size(), 0);
    mark_turned(turned);
    if (std::find(turned.begin(), turned.end(), 1) == turned.end()) return;
    const double kept = round < halvings ? 0.5 : 0;
    for (std::size_t v = 0; v < nodes.size(); ++v)
      if (turned[v]) nodes[v] = before[v] + kept * (nodes[v] - before[v]);
  }
}

}  // namespace tensegric_fit::control_mesh
