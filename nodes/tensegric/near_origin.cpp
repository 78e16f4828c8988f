#include "tensegric/near_origin.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// A power of two, so that sums with its multiples are exact. A chest's middle, 1.0 to 1.4 m high, is then
// within 0.125 m of the origin: a coarser grid would leave it as far away as its own size.
constexpr double kGrid = 0.25;  // m

// Along one axis. A difference from a multiple is exact, and so is the way back, where it is no larger than
// what it is taken from; where it would be, the points are near already.
double offset_of(const std::vector<Vector3d>& points, int axis) {
  double low = points.front()[axis], high = low, nearest = std::abs(low);
  for (const Vector3d& point : points) {
    low = std::min(low, point[axis]);
    high = std::max(high, point[axis]);
    nearest = std::min(nearest, std::abs(point[axis]));
  }
  const double by = -kGrid * std::round((low + high) / (2 * kGrid));
  return std::max(std::abs(low + by), std::abs(high + by)) <= nearest ? by : 0;
}

void move(std::vector<Vector3d>& points, const Vector3d& by) {
  for (Vector3d& point : points) point += by;
}

std::vector<Vector3d> moved(std::vector<Vector3d> points, const Vector3d& by) {
  move(points, by);
  return points;
}

}  // namespace

Vector3d offset_to_origin(const geometry::ControlMesh& control) {
  std::vector<Vector3d> points = control.outer;
  points.insert(points.end(), control.inner.begin(), control.inner.end());
  return {offset_of(points, 0), offset_of(points, 1), offset_of(points, 2)};
}

Model moved(Model model, const Vector3d& by) {
  move(model.control.outer, by);
  move(model.control.inner, by);
  return model;
}

Solution moved(Solution solution, const Vector3d& by) {
  for (std::vector<Vector3d>* points : {&solution.outer, &solution.inner, &solution.between})
    move(*points, by);
  for (LineResult& line : solution.lines) {
    move(line.course_at_rest, by);
    move(line.course, by);
    for (auto* fibres : {&line.fibres_at_rest, &line.fibres})
      for (std::vector<Vector3d>& fibre : *fibres) move(fibre, by);
  }
  for (Iterate& iterate : solution.history) move(iterate.tracked, by);
  return solution;
}

geometry::BoneFrames moved(const geometry::BoneFrames& bones, const Vector3d& by) {
  if (bones.still()) return bones;
  geometry::Spine spine = bones.spine();
  spine.body_from_scan.translate(-by);
  return {spine, bones.posture()};
}

std::vector<geometry::LaidLine> moved(std::vector<geometry::LaidLine> lines, const Vector3d& by) {
  for (geometry::LaidLine& line : lines)
    for (geometry::Fibre& fibre : line.fibres)
      for (geometry::CarriedPoint& point : fibre.points) point.rest += by;
  return lines;
}

Progress seen_from_scan(const Progress& asked, const Vector3d& by) {
  if (!asked) return {};
  return [asked, by](const Iterate& iterate, const std::vector<Vector3d>& outer,
                     const std::vector<Vector3d>& inner) {
    Iterate there = iterate;
    move(there.tracked, -by);
    return asked(there, moved(outer, -by), moved(inner, -by));
  };
}

SkinFolds seen_from_scan(const SkinFolds& asked, const Vector3d& by) {
  if (!asked) return {};
  return [asked, by](const std::vector<Vector3d>& outer, const std::vector<Vector3d>& inner) {
    return asked(moved(outer, -by), moved(inner, -by));
  };
}

std::vector<PosedVolume> seen_from_scan(const std::vector<PosedVolume>& asked, const Vector3d& by) {
  std::vector<PosedVolume> all;
  for (const PosedVolume& posed : asked)
    all.push_back(!posed ? posed : [posed, by](double share) -> VolumeFunction {
      return [volume = posed(share), by](const Positions& nodes, Positions* gradient) {
        return volume(moved(nodes, -by), gradient);
      };
    });
  return all;
}

}  // namespace tensegric_fit::tensegric
