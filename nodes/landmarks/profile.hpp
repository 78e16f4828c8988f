/// Vertical profiles: how skin runs down in a plane.
#pragma once

#include <optional>
#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// A profile in even steps, from top to bottom along the front of the plane (its side towards `outward`).
struct Profile {
  std::vector<Eigen::Vector3d> points;
  double step;               ///< metres along the skin
  Eigen::Vector3d sideways;  ///< normal of the plane: up cross outward

  /// Curvature at a point, 1/m, over `reach` steps each way; positive where the skin is hollow. Zero too near
  /// the ends.
  double hollowness(int at, int reach) const;

  /// Angle in radians between the skin above a point and the skin below it, each as the chord from `first` to
  /// `last` steps off; negative too near the ends.
  double opening(int at, int first, int last) const;

  /// The straight line along the skin from `first` to `last` steps below a point, above it where they are
  /// negative. Nothing where less than 60 % of these steps are there.
  struct Line {
    Eigen::Vector3d middle, direction;  ///< downwards along the skin, unit
  };
  std::optional<Line> line(int at, int first, int last) const;
};

/// The skin of the box [low, high] cut by the vertical plane through `origin` that holds `outward`
/// (horizontal, unit): the longest piece that looks outward and begins at the height of
/// `origin` or above, or else below it; smoothed over 3 mm. Empty where the plane misses the box's skin.
Profile cut_profile(const BodyShape& body, const std::vector<int>& triangles, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& outward);

/// Plane section of some of the body's triangles.
std::vector<geometry::SectionLoop> cut(const BodyShape& body, const std::vector<int>& triangles,
                                       const Eigen::Vector3d& origin, const Eigen::Vector3d& normal);

/// Triangles with their middle in a box, for cut and cut_profile.
std::vector<int> triangles_in_box(const BodyShape& body, const Eigen::Vector3d& low,
                                  const Eigen::Vector3d& high);

}  // namespace tensegric_fit::landmarks
