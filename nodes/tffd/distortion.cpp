#include "tffd/distortion.hpp"

#include <Eigen/Geometry>

#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

void check_count(std::size_t got, std::size_t wanted) {
  if (got != wanted)
    throw Refusal(refusal::kBadMesh, "distortion: not one value or position a control vertex");
}

std::vector<double> areas_around(const std::vector<Eigen::Vector3d>& vertices,
                                 const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<double> areas(vertices.size(), 0);
  for (const Eigen::Vector3i& t : triangles) {
    const double area = geometry::area_vector(vertices[t[0]], vertices[t[1]], vertices[t[2]]).norm() / 2;
    for (int k = 0; k < 3; ++k) areas[t[k]] += area;
  }
  return areas;
}

}  // namespace

std::vector<double> control_distortion(const Binding& binding, const std::vector<Eigen::Vector3d>& outer) {
  check_count(outer.size(), binding.outer().size());
  const std::vector<double> before = areas_around(binding.outer(), binding.control_triangles());
  std::vector<double> ratios = areas_around(outer, binding.control_triangles());
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] = before[i] > 0 ? ratios[i] / before[i] : 1;
  return ratios;
}

std::vector<double> body_distortion(const Binding& binding, const std::vector<double>& at_control_vertices) {
  const SparseRows& weights = binding.weights().values;
  check_count(at_control_vertices.size(), static_cast<std::size_t>(weights.cols()));
  std::vector<double> values(binding.vertices().size(), 1);
  for (const Anchor& anchor : binding.anchors())
    for (SparseRows::InnerIterator w(weights, anchor.vertex); w; ++w)
      values[anchor.vertex] += w.value() * (at_control_vertices[w.col()] - 1);
  return values;
}

}  // namespace tensegric_fit::tffd
