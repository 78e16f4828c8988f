/// Questions asked of the body's surface while a control mesh is laid on it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::control_mesh {

/// A part of the body's surface with an index over its triangles. All answers are exact for the mesh and do
/// not depend on the order of its triangles but for ties.
class Skin {
 public:
  /// \pre `surface` has passed check_mesh and is not empty
  explicit Skin(geometry::TriangleMesh surface);
  Skin(const Skin&) = delete;
  Skin& operator=(const Skin&) = delete;

  /// Where the ray first leaves the body, up to `reach` metres away. `direction` is a unit vector.
  std::optional<Eigen::Vector3d> first_exit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                            double reach) const;

  /// The point of the line through `from` nearest to it, at most `reach` away either way, where the skin
  /// faces along `direction`.
  std::optional<Eigen::Vector3d> nearest_along(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                               double reach) const;

  Eigen::Vector3d nearest(const Eigen::Vector3d& point) const;
  /// Of the skin nearest to `point`: a unit vector outward, steady across edges.
  Eigen::Vector3d normal_near(const Eigen::Vector3d& point) const;

  /// `count` points that divide the way over the skin from `a` to `b` evenly: along the plane section through
  /// both that is as square to `across` as can be, the shorter way round. Follows the skin into folds that a
  /// ray would miss.
  std::vector<Eigen::Vector3d> between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, int count,
                                       const Eigen::Vector3d& across) const;

 private:
  /// Triangles whose cells touch the box, ascending.
  std::vector<int> triangles_near(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;
  Eigen::Vector3i cell_of(const Eigen::Vector3d& point) const;
  /// First and last cell of the box round a triangle.
  std::array<Eigen::Vector3i, 2> cells_of(const Eigen::Vector3i& triangle) const;
  int number(int x, int y, int z) const { return (z * cells_.y() + y) * cells_.x() + x; }
  bool has_room() const;  ///< are there few enough cells, and triangles in them?

  geometry::TriangleMesh surface_;
  std::vector<Eigen::Vector3d> normals_;  // of its vertices
  geometry::SurfaceTree tree_;            // refers to surface_: a Skin is not copied
  Eigen::Vector3d corner_;
  double cell_;  // m
  Eigen::Vector3i cells_;
  std::vector<int> starts_;  // of cell i: entries_[starts_[i]] to entries_[starts_[i + 1]]
  std::vector<int> entries_;
};

}  // namespace tensegric_fit::control_mesh
