#include "landmarks/outline.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

Outline outline_of(std::vector<Eigen::Vector3d> points) {
  Outline outline;
  outline.points = std::move(points);
  const Eigen::Vector2d origin = outline.points.front().head<2>();
  outline.low = outline.high = origin;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double twice_area = 0;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Eigen::Vector2d p = outline.points[i].head<2>();
    const Eigen::Vector2d a = p - origin,
                          b = outline.points[(i + 1) % outline.points.size()].head<2>() - origin;
    twice_area += cross(a, b);
    moment += cross(a, b) * (a + b);
    outline.low = outline.low.cwiseMin(p);
    outline.high = outline.high.cwiseMax(p);
  }
  outline.area = twice_area / 2;
  outline.centroid = origin;
  if (std::abs(twice_area) > 1e-12) outline.centroid += moment / (3 * twice_area);
  return outline;
}

std::vector<Outline> outlines_of(const std::vector<geometry::SectionLoop>& loops) {
  std::vector<Outline> outlines;
  for (const geometry::SectionLoop& loop : loops) {
    if (!loop.closed || loop.points.size() < 3) continue;
    Outline outline = outline_of(loop.points);
    if (outline.area > 0) outlines.push_back(std::move(outline));
  }
  std::stable_sort(outlines.begin(), outlines.end(),
                   [](const Outline& a, const Outline& b) { return a.area > b.area; });
  return outlines;
}

bool contains(const Outline& outline, const Eigen::Vector2d& point) {
  if ((point.array() < outline.low.array()).any() || (point.array() > outline.high.array()).any())
    return false;
  bool inside = false;  // crossings of a ray along x
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Eigen::Vector3d &a = outline.points[i], &b = outline.points[(i + 1) % outline.points.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

Eigen::Matrix2d second_moment(const Outline& outline, const Eigen::Vector2d& centre) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const Eigen::Vector2d a = outline.points[i].head<2>() - centre;
    const Eigen::Vector2d b = outline.points[(i + 1) % outline.points.size()].head<2>() - centre;
    moment += cross(a, b) / 24 * ((a + b) * (a + b).transpose() + a * a.transpose() + b * b.transpose());
  }
  return moment;
}

std::vector<Eigen::Vector3d> tape_loop(const std::vector<Outline>& outlines) {
  std::vector<Eigen::Vector3d> points;
  for (const Outline& outline : outlines)
    points.insert(points.end(), outline.points.begin(), outline.points.end());
  return geometry::tape(points, Eigen::Vector3d::UnitZ());
}

double tape_length(const std::vector<Outline>& outlines) {
  return geometry::length_of(tape_loop(outlines), true);
}

}  // namespace tensegric_fit::landmarks
