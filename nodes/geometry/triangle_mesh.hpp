/// Triangle meshes: checks, normals, volume, topology.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
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

/// Sum of the signed volumes of the tetrahedra that join `apex` to every triangle, m^3: for a closed mesh its
/// volume, for any apex; for an open patch the volume measure of P1 §3.4.
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

/// All sides in order of (low, high, number): the sides of one edge are consecutive.
std::vector<TriangleSide> sorted_sides(const TriangleMesh& mesh);

/// An undirected edge (first < second) with its triangles: `left` runs from first to second, `right` from
/// second to first. On a boundary `left` is the only triangle, whichever its direction, and `right` is -1.
struct Edge {
  int first, second;
  int left, right;
};

/// Edges in ascending order of (first, second).
/// \throw Refusal bad_mesh: an edge with more than two triangles, or with two that run in the same direction.
std::vector<Edge> edges_of(const TriangleMesh& mesh);

/// True where every edge has two triangles that run in opposite directions.
bool is_closed(const TriangleMesh& mesh);

/// Vertices around each vertex (neighbours by an edge), each list ascending.
std::vector<std::vector<int>> neighbours_of(std::size_t vertex_count,
                                            const std::vector<Eigen::Vector3i>& triangles);

/// Index of the connected component (by shared vertices) of each triangle, numbered by first triangle.
std::vector<int> components_of(const TriangleMesh& mesh);

/// The triangles for which keep is non-zero, with the vertices that they use, in the original order.
TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<char>& keep);

/// The same of the triangles with these numbers, in their order: quicker where they are few.
TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<int>& triangles);

/// The highest place of the surface on the vertical through `point`, from `below` metres under it to `above`
/// metres over it; nothing where there is none.
std::optional<Eigen::Vector3d> highest_near(const TriangleMesh& mesh, const Eigen::Vector3d& point,
                                            double below, double above);

/// Lowest and highest corner of the box around the points. \pre not empty
std::array<Eigen::Vector3d, 2> bounding_box(const std::vector<Eigen::Vector3d>& points);

}  // namespace tensegric_fit::geometry
