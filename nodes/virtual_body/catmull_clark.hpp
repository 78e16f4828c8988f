/// Subdivision of a closed mesh of quads: E. Catmull, J. Clark, Recursively generated B-spline surfaces on
/// arbitrary topological meshes, Computer-Aided Design 10 (1978) 350-355.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace tensegric_fit::virtual_body {

using Quad = std::array<int, 4>;  ///< vertices, counter-clockwise from outside

/// One step. A new vertex lies near each old vertex, each edge and each quad, numbered in this order: the
/// first vertices keep their numbers. Each quad becomes four: old vertex, edge after it, quad, edge before
/// it.
class CatmullClark {
 public:
  /// \throw Refusal bad_mesh: a vertex that is not there or that no quad has, or an edge that not exactly two
  /// quads run along, each its own way
  CatmullClark(std::size_t vertices, const std::vector<Quad>& quads);

  std::size_t vertices() const { return valence_.size() + edges_.size() + coarse_.size(); }
  const std::vector<Quad>& quads() const { return quads_; }

  /// One value per new vertex from one per old vertex: positions, or anything else that can be averaged.
  template <typename T>
  std::vector<T> refined(const std::vector<T>& values) const;

 private:
  struct Edge {
    std::array<int, 2> ends, sides;  ///< vertices, quads
  };
  std::vector<Quad> coarse_, quads_;
  std::vector<Edge> edges_;
  std::vector<int> valence_;  ///< quads of each vertex
};

/// Two triangles a quad, cut from its first vertex to its third. Of subdivided quads that is from the old
/// vertex to the old quad, so that a mesh and its mirror image are cut alike.
std::vector<Eigen::Vector3i> triangles_of(const std::vector<Quad>& quads);

template <typename T>
std::vector<T> CatmullClark::refined(const std::vector<T>& values) const {
  const T zero = values.front() * 0.0;
  std::vector<T> faces, middles, corners(values.size(), zero);
  for (const Quad& q : coarse_)
    faces.push_back((values[q[0]] + values[q[1]] + values[q[2]] + values[q[3]]) * 0.25);
  for (std::size_t f = 0; f < coarse_.size(); ++f)
    for (const int v : coarse_[f])
      corners[v] += faces[f] * (1.0 / valence_[v]);  // Q, mean of the quads round a vertex
  for (const Edge& edge : edges_) {
    const T middle = (values[edge.ends[0]] + values[edge.ends[1]]) * 0.5;
    for (const int v : edge.ends)
      corners[v] += middle * (2.0 / valence_[v]);  // 2 R, of the middles of its edges
    middles.push_back(middle * 0.5 + (faces[edge.sides[0]] + faces[edge.sides[1]]) * 0.25);
  }
  std::vector<T> result;
  result.reserve(vertices());
  for (std::size_t v = 0; v < values.size(); ++v)  // (Q + 2 R + (n - 3) S) / n
    result.push_back((corners[v] + values[v] * (valence_[v] - 3.0)) * (1.0 / valence_[v]));
  result.insert(result.end(), middles.begin(), middles.end());
  result.insert(result.end(), faces.begin(), faces.end());
  return result;
}

}  // namespace tensegric_fit::virtual_body
