/// Triangle meshes and what can be said of one without knowing what it depicts.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace tensegric_fit::geometry {

/// Indexed triangles, counter-clockwise from outside. Metres.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

/// \throw Refusal non_finite, bad_mesh: a coordinate is not finite, an index out of range, a triangle has two
/// equal corners.
void check_mesh(const TriangleMesh& mesh);

/// Twice the area of a triangle times its unit normal.
inline Eigen::Vector3d area_vector(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

/// Area-weighted unit normals, one per vertex (zero where a vertex has no area around it).
std::vector<Eigen::Vector3d> vertex_normals(const std::vector<Eigen::Vector3d>& vertices,
                                            const std::vector<Eigen::Vector3i>& triangles);

/// Sum of the tetrahedra that join `apex` to every triangle, m^3: the volume of a closed mesh whatever the
/// apex, and the measure of an open patch's volume that P1 §3.4 uses.
double cone_volume(const std::vector<Eigen::Vector3d>& vertices,
                   const std::vector<Eigen::Vector3i>& triangles,
                   const Eigen::Vector3d& apex = Eigen::Vector3d::Zero());

/// A side of a triangle: it runs from the triangle's corner number % 3 to the next one.
struct TriangleSide {
  int low, high;  ///< its vertices, low < high
  int number;     ///< 3 * triangle + corner
  bool forward;   ///< from low to high

  int triangle() const { return number / 3; }
};

/// All sides by (low, high, number): those of one edge stand together.
std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh);

/// An undirected edge (first < second) with the triangles on it: `left` runs it from first to second, `right`
/// back. On a boundary `left` is the only triangle, whichever way it runs, and `right` is -1.
struct Edge {
  int first, second;
  int left, right;
};

/// Edges in ascending order of (first, second).
/// \throw Refusal bad_mesh: an edge with more than two triangles, or two that run it the same way.
std::vector<Edge> edges_of(const TriangleMesh& mesh);

/// True where every edge has two triangles that run it in opposite directions.
bool is_closed(const TriangleMesh& mesh);

/// Vertices around each vertex (neighbours by an edge), each list ascending.
std::vector<std::vector<int>> neighbours_of(std::size_t vertex_count,
                                            const std::vector<Eigen::Vector3i>& triangles);

/// Number of the connected component (by shared vertices) of each triangle, 0 the first one met.
std::vector<int> components_of(const TriangleMesh& mesh);

/// The triangles for which keep is non-zero, with the vertices that they use, in their old order.
TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<char>& keep);

/// Lowest and highest corner of the box around the points. \pre not empty
std::array<Eigen::Vector3d, 2> bounding_box(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::geometry
