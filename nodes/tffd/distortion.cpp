#include "tffd/distortion.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

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

using Sides = Eigen::Matrix<double, 3, 2>;

Sides sides_of(const Eigen::Vector3i& t, const std::vector<Eigen::Vector3d>& vertices) {
  return (Sides() << vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]).finished();
}

// Coordinates of the sides in the triangle's own plane, the first side along x.
Eigen::Matrix2d flat(const Sides& sides) {
  const Eigen::Vector3d u = sides.col(0), v = sides.col(1);
  const double length = u.norm();
  return (Eigen::Matrix2d() << length, u.dot(v) / length, 0, u.cross(v).norm() / length).finished();
}

}  // namespace

std::vector<double> control_distortion(const geometry::ControlMesh& control,
                                       const std::vector<Eigen::Vector3d>& outer) {
  check_count(outer.size(), control.outer.size());
  const std::vector<double> before = areas_around(control.outer, control.triangles);
  std::vector<double> ratios = areas_around(outer, control.triangles);
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

std::vector<Stretch> principal_stretches(const geometry::ControlMesh& control,
                                         const std::vector<Eigen::Vector3d>& outer) {
  check_count(outer.size(), control.outer.size());
  std::vector<Stretch> stretches;
  stretches.reserve(control.triangles.size());
  for (const Eigen::Vector3i& t : control.triangles) {
    const Eigen::Matrix2d before = flat(sides_of(t, control.outer));
    if (!(before.determinant() > 0))
      throw Refusal(refusal::kBadMesh, "distortion: a control triangle has no area");
    const Eigen::Vector2d most_least =
        Eigen::JacobiSVD<Sides>(sides_of(t, outer) * before.inverse()).singularValues();
    stretches.push_back({most_least[0], most_least[1]});
  }
  return stretches;
}

}  // namespace tensegric_fit::tffd
