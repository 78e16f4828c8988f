/// A mesh without what lies beyond a plane.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::geometry {

/// Each vertex of what is left, as a weighted mean of the whole mesh's vertices: one of weight 1 where it was
/// there before. So whatever the whole mesh has per vertex can be had for what is left.
struct CutMesh {
  using Mean = std::vector<std::pair<int, double>>;

  std::vector<Mean> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> left;  ///< per vertex of the whole mesh: its number now, or -1

  template <typename Value>
  std::vector<Value> of(const std::vector<Value>& whole) const {
    std::vector<Value> values;
    values.reserve(vertices.size());
    for (const Mean& mean : vertices) {
      Value value = mean.front().second * whole[mean.front().first];
      for (std::size_t i = 1; i < mean.size(); ++i) value += mean[i].second * whole[mean[i].first];
      values.push_back(value);
    }
    return values;
  }
};

/// Cuts off connected pieces beyond the plane (on the side of its normal) that `goes` says yes to, given
/// their vertices; other pieces beyond it stay. The cut runs in the plane and is closed by a fan.
CutMesh cut_off(const TriangleMesh& mesh, const Eigen::Hyperplane<double, 3>& plane,
                const std::function<bool(const std::vector<int>&)>& goes);

}  // namespace tensegric_fit::geometry
