/// The volume of one region and its derivatives: of the control mesh (P1 §3.4, tetrahedra from a fixed apex),
/// or of the body below it (tffd/README.md).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// Volume of the dense body under a region, m^3, for the outer and then the inner nodes, and where
/// `gradient` is not null its gradient by each of them.
using VolumeFunction = std::function<double(const Positions& nodes, Positions* gradient)>;

/// The same where body and nodes at rest have gone with that share of the posture, 0 to 1.
using PosedVolume = std::function<VolumeFunction(double share)>;

/// `rest` is to be kept. `area` (m^2) is the size of the volume's gradient by the free nodes at rest, so that
/// (volume - rest) / area is a length; 1 where the region has no free node.
struct RegionVolume {
  std::string name;
  std::vector<Eigen::Vector3i> triangles;
  Eigen::Vector3d apex;
  PosedVolume body_at;  ///< empty: the control mesh's own volume is kept
  VolumeFunction body;  ///< body_at the posture's present share
  int body_nodes = 0;   ///< outer and inner
  double rest = 0;
  double area = 1;
  double control_rest = 0;  ///< of the control mesh, m^3
  double control_area = 1;  ///< of the control mesh, as `area`
};

/// `free_index` of the nodes as of Model::free_index. A body's volume is kept only where the region has free
/// nodes of its own.
RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region,
                              const std::vector<int>& free_index, const PosedVolume& body_at = {});
RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region);

/// The volume that is kept, and the control mesh's whichever is kept.
double volume(const RegionVolume& region, const Positions& x);
double control_volume(const RegionVolume& region, const Positions& x);

/// (V - V0) / V0; of a flat patch, which has no volume of its own, relative to area^(3/2).
double volume_error(const RegionVolume& region, double volume);
double volume_error(const RegionVolume& region, const Positions& x);
/// Of the control mesh's volume, whichever is kept.
double control_volume_error(const RegionVolume& region, double volume);
/// m^3, what volume_error is relative to, above 0.
double volume_scale(const RegionVolume& region);

/// Adds `scale` times the volume's gradient by the free nodes; returns the volume.
double add_volume_gradient(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                           double scale, Eigen::Ref<Eigen::VectorXd> gradient);

/// Adds `scale` times the volume's second derivative (indefinite): for a body that of the control mesh, in
/// proportion, since the two volumes grow alike.
void add_volume_hessian(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian);

}  // namespace tensegric_fit::tensegric
