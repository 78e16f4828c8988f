#include "tensegric/region_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tensegric_fit::tensegric {
namespace {

void add_control_gradient(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
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

double body_volume(const RegionVolume& region, const Positions& x, Positions* by_node) {
  return region.body({x.begin(), x.begin() + region.body_nodes}, by_node);
}

int count_free(const std::vector<int>& free_index) {
  return static_cast<int>(std::count_if(free_index.begin(), free_index.end(), [](int i) { return i >= 0; }));
}

/// m^3, what errors of a volume are relative to.
double signed_scale(double rest, double area) {
  const double flat = std::pow(area, 1.5);
  return std::abs(rest) > 1e-6 * flat ? rest : flat;
}

}  // namespace

RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region,
                              const std::vector<int>& free_index, const PosedVolume& body_at) {
  RegionVolume result;
  result.name = region.name;
  result.triangles = geometry::region_triangles(model.control, region);
  result.apex = geometry::region_apex(model.control, region);
  const Positions rest = model.rest_positions();
  result.rest = result.control_rest = control_volume(result, rest);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * count_free(free_index));
  add_control_gradient(result, rest, free_index, 1, gradient);
  if (gradient.norm() == 0) return result;
  result.area = result.control_area = gradient.norm();
  if (!body_at) return result;
  result.body_at = body_at;
  result.body = body_at(0);
  result.body_nodes = 2 * static_cast<int>(model.control.outer.size());
  gradient.setZero();
  result.rest = add_volume_gradient(result, rest, free_index, 1, gradient);
  result.area = gradient.norm();
  return result;
}

RegionVolume region_volume_of(const Model& model, const geometry::ControlRegion& region) {
  return region_volume_of(model, region, model.free_index());
}

double volume(const RegionVolume& region, const Positions& x) {
  return region.body ? body_volume(region, x, nullptr) : control_volume(region, x);
}

double control_volume(const RegionVolume& region, const Positions& x) {
  return geometry::cone_volume(x, region.triangles, region.apex);
}

double volume_error(const RegionVolume& region, double volume) {
  return (volume - region.rest) / signed_scale(region.rest, region.area);
}

double control_volume_error(const RegionVolume& region, double volume) {
  return (volume - region.control_rest) / signed_scale(region.control_rest, region.control_area);
}

double volume_scale(const RegionVolume& region) {
  return std::abs(signed_scale(region.rest, region.area));
}

double volume_error(const RegionVolume& region, const Positions& x) {
  return volume_error(region, volume(region, x));
}

double add_volume_gradient(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                           double scale, Eigen::Ref<Eigen::VectorXd> gradient) {
  if (!region.body) {
    add_control_gradient(region, x, free_index, scale, gradient);
    return control_volume(region, x);
  }
  Positions by_node;
  const double value = body_volume(region, x, &by_node);
  for (std::size_t i = 0; i < by_node.size(); ++i)
    if (free_index[i] >= 0) gradient.segment<3>(3 * free_index[i]) += scale * by_node[i];
  return value;
}

void add_volume_hessian(const RegionVolume& region, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian) {
  const double proportion = region.area / region.control_area;
  for (const Eigen::Vector3i& t : region.triangles) {
    for (int k = 0; k < 3; ++k) {
      // The gradient by corner k is p x q / 6; by p it changes as -[q]x / 6.
      const Eigen::Vector3d q = scale * proportion / 6 * (x[t[(k + 2) % 3]] - region.apex);
      Eigen::Matrix3d block;
      block << 0, q.z(), -q.y(), -q.z(), 0, q.x(), q.y(), -q.x(), 0;
      hessian.add(free_index[t[k]], free_index[t[(k + 1) % 3]], block);
    }
  }
}

}  // namespace tensegric_fit::tensegric
