/// Control triangles as t-FFD sees them at rest (P1 §3.2, README.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/control_mesh.hpp"

namespace tensegric_fit::tffd {

/// A control triangle at rest: corner 0, U and V along two sides, W off the plane; q = corner 0 + u U + v V +
/// w W.
struct Frame {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;                            ///< unit
  Eigen::Matrix3d local_from_offset;                 ///< inverse of [U V W]
  Eigen::Matrix<double, 2, 3> in_plane_from_offset;  ///< the same with the normal for W, first two rows
  double area;                                       ///< m^2
  double radius;                                     ///< mean distance from the centroid to the corners, m

  /// A quick test: false only where the triangle may be as near as `distance` (no corner is farther from the
  /// centroid than 1.5 times their mean).
  bool farther_than(double distance, const Eigen::Vector3d& q) const {
    const double from_centroid = distance + 1.5 * radius;
    return (q - centroid).squaredNorm() > from_centroid * from_centroid;
  }

  /// (u, v, w) of a point.
  Eigen::Vector3d local(const Eigen::Vector3d& q) const { return local_from_offset * (q - corners[0]); }

  /// Barycentric coordinates of the triangle's point that is closest to `q`: none negative, sum 1.
  Eigen::Vector3d closest(const Eigen::Vector3d& q) const;

  Eigen::Vector3d at(const Eigen::Vector3d& barycentric) const {
    return barycentric[0] * corners[0] + barycentric[1] * corners[1] + barycentric[2] * corners[2];
  }
};

/// What W is.
enum class Axis {
  unit_normal,    ///< of the triangle
  inner_to_outer  ///< from the centroid of the inner triangle to that of the outer one
};

/// One a control triangle. \throw Refusal bad_mesh: a triangle without area, or inner nodes in the plane of
/// the outer ones
std::vector<Frame> frames_of(const geometry::ControlMesh& control, Axis axis);

}  // namespace tensegric_fit::tffd
