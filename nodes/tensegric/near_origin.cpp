#include "tensegric/near_origin.hpp"

#include <cmath>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Vector3d;

// Tolerances. At 16 m balances round ten times as far as in a booth (residual 1e-9, of 1e-8 that is let
// pass). Below, results stay what they are in a scan's own frame. Multiples of 8 m leave coordinates of at
// most 4 m and the body's own, smaller than what they came from: differences are exact, and so is the way
// back.
constexpr double kFar = 16, kGrid = 8;  // m

void move(std::vector<Vector3d>& points, const Vector3d& by) {
  for (Vector3d& point : points) point += by;
}

std::vector<Vector3d> moved(std::vector<Vector3d> points, const Vector3d& by) {
  move(points, by);
  return points;
}

}  // namespace

Vector3d offset_to_origin(const std::vector<Vector3d>& points) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  return mean.unaryExpr([](double at) { return std::abs(at) < kFar ? 0 : -kGrid * std::round(at / kGrid); });
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

Progress asked_unmoved(const Progress& asked, const Vector3d& by) {
  if (!asked) return {};
  return [asked, by](const Iterate& iterate, const std::vector<Vector3d>& outer,
                     const std::vector<Vector3d>& inner) {
    Iterate there = iterate;
    move(there.tracked, -by);
    return asked(there, moved(outer, -by), moved(inner, -by));
  };
}

SkinFolds asked_unmoved(const SkinFolds& asked, const Vector3d& by) {
  if (!asked) return {};
  return [asked, by](const std::vector<Vector3d>& outer, const std::vector<Vector3d>& inner) {
    return asked(moved(outer, -by), moved(inner, -by));
  };
}

std::vector<PosedVolume> asked_unmoved(const std::vector<PosedVolume>& asked, const Vector3d& by) {
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
