#include "tffd/line_over_skin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/section.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.01;       // m, along a line
constexpr double kMostSteps = 1000;  // between two points of a line: no body is larger
constexpr double kAround = 0.05;     // m, of skin about a line that is looked at

std::vector<Vector3d> stepped(const std::vector<Vector3d>& course) {
  std::vector<Vector3d> points;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const Vector3d way = course[i] - course[i - 1];
    const int steps = static_cast<int>(std::clamp(std::ceil(way.norm() / kStep), 1.0, kMostSteps));
    for (int k = 0; k < steps; ++k) points.push_back(course[i - 1] + (k + 0.5) / steps * way);
  }
  return points;
}

// The triangles about a course.
std::vector<int> triangles_about(const std::vector<Vector3d>& course,
                                 const std::vector<Eigen::Vector3i>& skin,
                                 const std::vector<Vector3d>& vertices) {
  auto [low, high] = geometry::bounding_box(course);
  low.array() -= kAround;
  high.array() += kAround;
  std::vector<int> triangles;
  for (std::size_t i = 0; i < skin.size(); ++i) {
    const Eigen::Vector3i& t = skin[i];
    const Vector3d& corner = vertices[t[0]];
    if ((corner.array() < low.array()).any() || (corner.array() > high.array()).any()) continue;
    if (geometry::distance_to_line(corner, course) < kAround) triangles.push_back(static_cast<int>(i));
  }
  return triangles;
}

}  // namespace

LineOverSkin line_over_skin(const std::vector<Vector3d>& course, const std::vector<Eigen::Vector3i>& skin,
                            const std::vector<Vector3d>& vertices) {
  LineOverSkin line;
  if (course.empty()) return line;
  line.triangles = triangles_about(course, skin, vertices);
  if (line.triangles.empty()) return line;
  geometry::TriangleMesh about{{}, {}};
  for (const int t : line.triangles) {
    const int first = static_cast<int>(about.vertices.size());
    for (const int v : skin[t]) about.vertices.push_back(vertices[v]);
    about.triangles.emplace_back(first, first + 1, first + 2);
  }
  const geometry::SurfaceTree tree(about);
  for (const Vector3d& point : stepped(course)) {
    const geometry::SurfacePoint foot = tree.nearest(point);
    const Eigen::Vector3i& t = about.triangles[foot.triangle];
    const Vector3d normal =
        geometry::area_vector(about.vertices[t[0]], about.vertices[t[1]], about.vertices[t[2]]).normalized();
    line.feet.push_back(foot.position);
    line.below.push_back(line.triangles[foot.triangle]);
    const Vector3d way = point - foot.position;
    line.heights.push_back(way.norm() > kAround ? kAround : normal.dot(way));
  }
  return line;
}

std::vector<int> triangles_below(const LineOverSkin& line, const std::vector<Vector3d>& feet,
                                 const std::vector<Eigen::Vector3i>& triangles,
                                 const std::vector<Vector3d>& vertices, double reach) {
  std::vector<int> below;
  for (const int i : line.triangles) {
    const Eigen::Vector3i& t = triangles[i];
    const Vector3d middle = (vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3;
    if (std::any_of(feet.begin(), feet.end(),
                    [&](const Vector3d& foot) { return (foot - middle).squaredNorm() < reach * reach; }))
      below.push_back(i);
  }
  return below;
}

}  // namespace tensegric_fit::tffd
