#include "tensegric/region_volume.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace tensegric_fit::tensegric {

RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region) {
  RegionVolume result;
  result.name = region.name;
  result.triangles = geometry::region_triangles(model.control, region);
  result.apex = geometry::region_apex(model.control, region);
  const Positions rest = model.rest_positions();
  result.rest = volume(result, rest);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * model.free_nodes());
  add_volume_gradient(result, rest, model.free_index(), 1, gradient);
  if (gradient.norm() > 0) result.area = gradient.norm();
  return result;
}

double volume(const RegionVolume& region, const Positions& x) {
  return geometry::cone_volume(x, region.triangles, region.apex);
}

double volume_error(const RegionVolume& region, const Positions& x) {
  const double flat = 1e-6 * std::pow(region.area, 1.5);
  return (volume(region, x) - region.rest) /
         (std::abs(region.rest) > flat ? region.rest : std::pow(region.area, 1.5));
}

void add_volume_gradient(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                         double scale, Eigen::Ref<Eigen::VectorXd> gradient) {
  for (const Eigen::Vector3i& t : region.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int row = free_index[t[k]];
      if (row < 0) continue;
      const Eigen::Vector3d p = x[t[(k + 1) % 3]] - region.apex, q = x[t[(k + 2) % 3]] - region.apex;
      gradient.segment<3>(3 * row) += scale / 6 * p.cross(q);
    }
  }
}

void add_volume_hessian(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian) {
  for (const Eigen::Vector3i& t : region.triangles) {
    for (int k = 0; k < 3; ++k) {
      // The gradient by corner k is p x q / 6; by p it changes as -[q]x / 6.
      const Eigen::Vector3d q = scale / 6 * (x[t[(k + 2) % 3]] - region.apex);
      Eigen::Matrix3d block;
      block << 0, q.z(), -q.y(), -q.z(), 0, q.x(), q.y(), -q.x(), 0;
      hessian.add(free_index[t[k]], free_index[t[(k + 1) % 3]], block);
    }
  }
}

}  // namespace tensegric_fit::tensegric
