#include "landmarks/surface_point.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

std::vector<int> vertices_near(const BodyShape& body, const Vector3d& centre, double radius) {
  std::vector<int> near;
  for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v)
    if ((body.mesh.vertices[v] - centre).squaredNorm() < radius * radius) near.push_back(static_cast<int>(v));
  return near;
}

// Quadric w(u, v) over the plane across `direction`; the apex, or false where it is not a maximum within
// `radius`.
bool fitted_apex(const std::vector<Vector3d>& points, const Vector3d& centre, const Vector3d& direction,
                 double radius, Vector3d& apex) {
  if (points.size() < 12) return false;  // twice the unknowns
  const Vector3d u = direction.unitOrthogonal(), v = direction.cross(u);
  Eigen::MatrixXd terms(points.size(), 6);
  Eigen::VectorXd heights(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d d = (points[i] - centre) / radius;
    const double a = u.dot(d), b = v.dot(d);
    terms.row(i) << 1, a, b, a * a, a * b, b * b;
    heights[i] = direction.dot(d);
  }
  const Eigen::VectorXd c = terms.colPivHouseholderQr().solve(heights);
  Eigen::Matrix2d curvature;
  curvature << 2 * c[3], c[4], c[4], 2 * c[5];
  if (curvature.determinant() <= 0 || curvature.trace() >= 0) return false;
  const Eigen::Vector2d top = -curvature.inverse() * Eigen::Vector2d(c[1], c[2]);
  if (top.norm() > 1) return false;
  const double height = c[0] + 0.5 * top.dot(Eigen::Vector2d(c[1], c[2]));
  apex = centre + radius * (top.x() * u + top.y() * v + height * direction);
  return true;
}

}  // namespace

std::vector<int> vertices_in_box(const BodyShape& body, const Vector3d& low, const Vector3d& high) {
  std::vector<int> inside;
  for (std::size_t i = 0; i < body.mesh.vertices.size(); ++i) {
    const Vector3d& p = body.mesh.vertices[i];
    if ((p.array() >= low.array()).all() && (p.array() <= high.array()).all())
      inside.push_back(static_cast<int>(i));
  }
  return inside;
}

int furthest_vertex(const BodyShape& body, const std::vector<int>& among, const Vector3d& direction) {
  return *std::max_element(among.begin(), among.end(), [&](int a, int b) {
    return direction.dot(body.mesh.vertices[a]) < direction.dot(body.mesh.vertices[b]);
  });
}

Vector3d apex_of_bulge(const BodyShape& body, const Vector3d& start, const Vector3d& direction,
                       double radius) {
  Vector3d apex = start;
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<Vector3d> points;
    for (int v : vertices_near(body, apex, radius))
      if (body.normals[v].dot(direction) > 0.3) points.push_back(body.mesh.vertices[v]);
    if (!fitted_apex(points, apex, direction, radius, apex)) break;
  }
  return apex;
}

}  // namespace tensegric_fit::landmarks
