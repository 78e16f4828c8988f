/// A body's true skin: what planes cut of it and tapes round it. Body frame (x forward, y left, z up),
/// metres.
#pragma once

#include <optional>
#include <vector>

#include "geometry/section.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::virtual_body {

/// A direction (unit) from a place.
struct Ray {
  Eigen::Vector3d origin, direction;
};

using Tape = std::vector<Eigen::Vector3d>;  ///< a closed loop

/// Trunk: all but the arms, legs, neck and head included.
enum class Part { whole, trunk, arms };

class Skin {
 public:
  /// `arm`: of each vertex, how much of it belongs to an arm, 0 to 1; a triangle is arm where the mean of its
  /// corners is above one half. \pre one share a vertex
  Skin(geometry::TriangleMesh mesh, const std::vector<double>& arm);

  const geometry::TriangleMesh& mesh(Part part = Part::whole) const;
  /// What a plane cuts of that part; slivers of a few points, where an arm is cut off, are left out.
  std::vector<geometry::SectionLoop> cut(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal,
                                         Part part) const;
  /// Round all loops of the trunk at a height, a breast that hangs below its fold included. Empty where there
  /// is no trunk.
  Tape round_trunk(double height) const;
  /// Round the widest of them alone.
  Tape round_torso(double height) const;
  /// Round the loop whose middle is nearest to `origin`. Empty where there is none.
  Tape round_nearest(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal, Part part) const;
  /// The line nearest to `near` that the sagittal plane through `near` cuts; closed or not. Empty where there
  /// is none.
  geometry::SectionLoop sagittal(const Eigen::Vector3d& near, Part part) const;
  /// The highest skin on the vertical through a point under the skin, at most 0.11 m above it; nothing where
  /// there is none.
  std::optional<Eigen::Vector3d> above(const Eigen::Vector3d& point) const;

 private:
  geometry::TriangleMesh whole_, trunk_, arms_;
};

double girth(const Tape& tape);  ///< m

}  // namespace tensegric_fit::virtual_body
