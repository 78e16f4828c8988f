/// The volume of one region of the control mesh and its derivatives (P1 §3.4): tetrahedra from a fixed apex.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

/// A cubic of the outer nodes. `rest` is to be kept. `area` (m^2) is the size of its gradient by the free
/// nodes at rest, so that (volume - rest) / area is a length; 1 where the region has no free node.
struct RegionVolume {
  std::string name;
  std::vector<Eigen::Vector3i> triangles;
  Eigen::Vector3d apex;
  double rest = 0;
  double area = 1;
};

RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region);

double volume(const RegionVolume& region, const Positions& x);

/// (V - V0) / V0; of a flat patch, which has no volume of its own, relative to area^(3/2).
double volume_error(const RegionVolume& region, const Positions& x);

/// Adds `scale` times the volume's gradient by the free nodes.
void add_volume_gradient(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                         double scale, Eigen::Ref<Eigen::VectorXd> gradient);

/// Adds `scale` times the volume's second derivative (indefinite).
void add_volume_hessian(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian);

}  // namespace tensegric_fit::tensegric
