#include "geometry/winding_number.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace tensegric_fit::geometry {

double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point,
                          c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * M_PI);
}

}  // namespace tensegric_fit::geometry
