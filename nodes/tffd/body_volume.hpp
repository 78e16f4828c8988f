/// The body's own volume under a region of the control mesh, as a function of the control nodes (README.md).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/posture.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::tffd {

/// The body's triangles that each of the control mesh's regions carries, one list a region. A triangle with a
/// reached vertex goes to the region whose nodes have the most weight in it (the first of equals), or to none
/// where nodes outside all regions have more. \pre the binding is in the standard setting
std::vector<std::vector<Eigen::Vector3i>> carried_triangles(const Binding& binding,
                                                            const std::vector<Eigen::Vector3i>& triangles,
                                                            const geometry::ControlMesh& control);

/// Sum of the tetrahedra that join a fixed apex to the given triangles, m^3. With M constant it is a cubic of
/// the nodes, exact with its gradient. Stands alone: it keeps nothing of the binding but copies.
class BodyVolume {
 public:
  /// `triangles` of the body, such as one of carried_triangles().
  /// \throw Refusal bad_option: a binding in the paper's setting, which has no constant M
  BodyVolume(const Binding& binding, const std::vector<Eigen::Vector3i>& triangles,
             const Eigen::Vector3d& apex);

  /// For 2V nodes, outer ones first; `gradient` is assigned one vector a node where it is not null (m^2).
  /// \throw Refusal bad_mesh: another number of nodes
  double operator()(const std::vector<Eigen::Vector3d>& nodes, std::vector<Eigen::Vector3d>* gradient) const;

  double at_rest() const { return rest_volume_; }

  /// Where the bones have carried body, nodes at rest and apex, with `share` of their angles.
  BodyVolume posed(const geometry::BoneFrames& bones, double share) const;

 private:
  Eigen::Vector3d apex_;
  std::vector<Eigen::Vector3d> rest_nodes_;
  std::vector<Eigen::Vector3d> rest_;       // the triangles' vertices from the apex on, reached ones first
  std::vector<Eigen::Vector3i> triangles_;  // into rest_
  std::vector<int> starts_;                 // of reached vertex i: entries starts_[i] to starts_[i + 1]
  std::vector<int> columns_;
  std::vector<double> weights_;
  double rest_volume_;
};

}  // namespace tensegric_fit::tffd
