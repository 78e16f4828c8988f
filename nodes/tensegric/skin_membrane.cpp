#include "tensegric/skin_membrane.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

constexpr double kFlatTriangle =
    1e-6;  // area over the square of its longest side: its directions are rounding

Triangle corners_of(const SkinTriangle& one, const Positions& x) {
  return {x[one.nodes[0]] - one.origin, x[one.nodes[1]] - one.origin, x[one.nodes[2]] - one.origin};
}

// Twice the area's vector, and the side opposite to each corner.
struct Sides {
  Vector3d area;
  std::array<Vector3d, 3> opposite;
};
Sides sides_of(const Triangle& p) {
  return {(p[1] - p[0]).cross(p[2] - p[0]), {p[2] - p[1], p[0] - p[2], p[1] - p[0]}};
}

// The energy's derivative by the area.
double by_area(const SkinTriangle& one, double area) {
  return one.stiffness * (3 * (area / one.rest - 1) - 1);
}

}  // namespace

std::vector<SkinTriangle> skin_triangles(const Model& model, const std::vector<int>& free_index) {
  std::vector<SkinTriangle> skin;
  const ModelOptions& options = model.options;
  if (options.skin == 0 || options.uniform) return skin;
  for (const Eigen::Vector3i& nodes : model.control.triangles) {
    const Positions& rest = model.control.outer;
    SkinTriangle one{nodes, {}, rest[nodes[0]], 0, options.skin * model.tissue / 3};
    const Sides sides = sides_of(corners_of(one, rest));
    one.rest = sides.area.norm() / 2;
    double longest = 0;
    bool is_free = false;
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, sides.opposite[i].squaredNorm());
      is_free = is_free || free_index[nodes[i]] >= 0;
    }
    if (!is_free || !(one.rest > kFlatTriangle * longest)) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) one.form(i, j) = sides.opposite[i].dot(sides.opposite[j]) / (4 * one.rest);
    skin.push_back(one);
  }
  return skin;
}

double skin_energy(const std::vector<SkinTriangle>& skin, const Positions& x) {
  double energy = 0;
  for (const SkinTriangle& one : skin) {
    const Triangle p = corners_of(one, x);
    const double strain = sides_of(p).area.norm() / 2 / one.rest - 1;
    double squares = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) squares += one.form(i, j) * p[i].dot(p[j]);
    energy += one.stiffness * (squares + one.rest * (3 * strain * strain - 2 * strain - 2)) / 2;
  }
  return energy;
}

void add_skin_gradient(const std::vector<SkinTriangle>& skin, const Positions& x,
                       const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const SkinTriangle& one : skin) {
    const Triangle p = corners_of(one, x);
    const Sides sides = sides_of(p);
    const double length = sides.area.norm();
    const Vector3d normal = length > 0 ? Vector3d(sides.area / length) : Vector3d(0, 0, 0);
    const double force = by_area(one, length / 2);
    for (int i = 0; i < 3; ++i) {
      const int row = free_index[one.nodes[i]];
      if (row < 0) continue;
      Vector3d sum = force / 2 * normal.cross(sides.opposite[i]);
      for (int j = 0; j < 3; ++j) sum += one.stiffness * one.form(i, j) * p[j];
      gradient.segment<3>(3 * row) += sum;
    }
  }
}

void add_skin_hessian(const std::vector<SkinTriangle>& skin, const Positions& x,
                      const std::vector<int>& free_index, NodeMatrix& hessian, double whole) {
  for (const SkinTriangle& one : skin) {
    const Sides sides = sides_of(corners_of(one, x));
    const double length = sides.area.norm();
    if (!(length > 0)) continue;
    const Vector3d normal = sides.area / length;
    const Matrix3d across = (Matrix3d::Identity() - normal * normal.transpose()) / length;
    const double force = whole * by_area(one, length / 2) / 2, stiffness = 3 * one.stiffness / one.rest / 4;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) {
        const Vector3d &a = sides.opposite[i], &b = sides.opposite[j];
        Matrix3d block = stiffness * normal.cross(a) * normal.cross(b).transpose() -
                         force * cross_matrix(a) * across * cross_matrix(b);
        block.diagonal().array() += one.stiffness * one.form(i, j);
        if (i != j) block += (i == j + 1 ? force : -force) * cross_matrix(normal);
        hessian.add(free_index[one.nodes[i]], free_index[one.nodes[j]], block);
      }
  }
}

}  // namespace tensegric_fit::tensegric
