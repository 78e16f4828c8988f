#include "inspect/solid_lines.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/rigid_motion.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kSides = 6;  // of a tube

std::vector<Eigen::Vector3d> without_repeats(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kNear = 1e-9;  // m: the direction of less may be lost
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& point : points)
    if (kept.empty() || (point - kept.back()).norm() > kNear) kept.push_back(point);
  return kept;
}

// Quads between two rows of `count` vertices each that begin at `row` and `next`; `closed`: the last to the
// first, too.
void join_rows(int row, int next, int count, bool closed, geometry::TriangleMesh& mesh) {
  for (int k = 0; k + 1 < count + closed; ++k) {
    const int l = (k + 1) % count;
    mesh.triangles.emplace_back(row + k, row + l, next + l);
    mesh.triangles.emplace_back(row + k, next + l, next + k);
  }
}

void add_tube(const Stroke& stroke, double radius, PaintedSurface& surface) {
  const std::vector<Eigen::Vector3d> points = without_repeats(stroke.points);
  if (points.size() < 2) return;
  Eigen::Vector3d along = (points[1] - points[0]).normalized(), aside = along.unitOrthogonal();
  const bool closed = points.size() > 3 && points.front() == points.back();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d &before = points[i > 0    ? i - 1
                                           : closed ? points.size() - 2
                                                    : 0],
                          &after = points[i + 1 < points.size() ? i + 1
                                          : closed              ? 1
                                                                : i];
    const Eigen::Vector3d turned = (after - before).normalized();
    if (turned.squaredNorm() > 0.5) {  // not where the line turns back on itself
      aside = geometry::shortest_turn(along, turned) * aside;
      along = turned;
    }
    const int row = static_cast<int>(surface.mesh.vertices.size());
    for (int k = 0; k < kSides; ++k) {
      const Eigen::Vector3d out = Eigen::AngleAxisd(2 * M_PI * k / kSides, along) * aside;
      surface.mesh.vertices.push_back(points[i] + radius * out);
      surface.normals.push_back(out);
      surface.colours.push_back(stroke.colour);
    }
    if (i > 0) join_rows(row - kSides, row, kSides, true, surface.mesh);
  }
}

}  // namespace

PaintedSurface tubes(const std::vector<Stroke>& strokes, double radius) {
  PaintedSurface surface;
  for (const Stroke& stroke : strokes) add_tube(stroke, radius, surface);
  return surface;
}

PaintedSurface surface_of(const std::vector<Ribbon>& ribbons) {
  PaintedSurface surface;
  for (const Ribbon& ribbon : ribbons) {
    geometry::TriangleMesh strip;
    for (const auto& fibre : ribbon.fibres)
      strip.vertices.insert(strip.vertices.end(), fibre.begin(), fibre.end());
    const int count = static_cast<int>(ribbon.fibres.front().size());
    for (std::size_t f = 1; f < ribbon.fibres.size(); ++f)
      join_rows(static_cast<int>(f - 1) * count, static_cast<int>(f) * count, count, false, strip);
    const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(strip.vertices, strip.triangles);
    for (const int side : {1, -1}) {
      const int first = static_cast<int>(surface.mesh.vertices.size());
      surface.mesh.vertices.insert(surface.mesh.vertices.end(), strip.vertices.begin(), strip.vertices.end());
      for (const Eigen::Vector3d& normal : normals) surface.normals.push_back(side * normal);
      surface.colours.insert(surface.colours.end(), normals.size(), ribbon.colour);
      for (const Eigen::Vector3i& t : strip.triangles)
        surface.mesh.triangles.push_back(side > 0
                                             ? Eigen::Vector3i(first + t[0], first + t[1], first + t[2])
                                             : Eigen::Vector3i(first + t[0], first + t[2], first + t[1]));
    }
  }
  return surface;
}

}  // namespace tensegric_fit::inspect
