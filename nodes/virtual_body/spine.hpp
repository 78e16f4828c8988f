/// How the trunk bends forward: a stoop, in the sagittal plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tensegric_fit::virtual_body {

/// The spine as an upright line that bends into arcs; what is above an arc turns with its end. Metres,
/// radians, x forward, z up.
class Spine {
 public:
  /// From height `low` to `high` the line x = `x` bends by `angle`, forward where that is positive.
  struct Arc {
    double low, high, x, angle;
  };

  /// \pre arcs in ascending order, apart; each angle less than 1
  explicit Spine(std::vector<Arc> arcs) : arcs_(std::move(arcs)) {}

  /// Where a point of the bent body was on the upright one. Continuous, with continuous slopes.
  Eigen::Vector3d straightened(Eigen::Vector3d p) const;
  /// The other way.
  Eigen::Vector3d bent(Eigen::Vector3d p) const;
  /// The direction `d` at a point of the upright body, unit.
  Eigen::Vector3d bent_direction(const Eigen::Vector3d& p, const Eigen::Vector3d& d) const;

 private:
  std::vector<Arc> arcs_;
};

}  // namespace tensegric_fit::virtual_body
