/// Planes across the neck and the tapes in them.
#pragma once

#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

/// A plane across the neck that leans forward by `lean` radians.
struct NeckPlane {
  Eigen::Vector3d origin;
  double lean;
};

/// Lean of the neck's plane on a body that does not stoop, radians.
inline constexpr double kUprightLean = 23 * 3.14159265358979323846 / 180;

/// Skin round the neck, looked at once for many planes.
class NeckPlanes {
 public:
  /// `middle` lies in the neck.
  NeckPlanes(const BodyShape& body, const Eigen::Vector3d& middle);

  /// Normal of a plane that leans forward by `lean` radians.
  static Eigen::Vector3d normal_of(double lean);

  /// The tape round the neck in the plane through `origin`; empty where it is not closed round it.
  std::vector<Eigen::Vector3d> tape(const Eigen::Vector3d& origin, double lean) const;
  /// Its length, or far too much where there is none.
  double girth(const Eigen::Vector3d& origin, double lean) const;
  /// The lean of the least girth through a point.
  double least_lean(const Eigen::Vector3d& origin) const;

  /// Middle of the box round a tape, in the plane of `origin` and `lean`; `origin` where there is no tape.
  Eigen::Vector3d middle_of_tape(const Eigen::Vector3d& origin, double lean) const;

 private:
  const BodyShape& body_;
  std::vector<int> skin_;
};

}  // namespace tensegric_fit::landmarks
