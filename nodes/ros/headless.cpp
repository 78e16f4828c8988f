#include "ros/headless.hpp"

#include <algorithm>

#include "geometry/cut_off.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Plane = Eigen::Hyperplane<double, 3>;

constexpr double kAboveTape = 0.01;   // m: the tape of the neck stays
constexpr double kAboveBase = 0.03;   // m above the neck's base, where there is no tape
constexpr double kTallerThan = 0.03;  // m that a head rises above the cut
constexpr double kLeastArea = 1e-6;   // m^2, twice: a neck has 0.01
constexpr double kReach = 0.3;        // m round the neck: a head with its hair, and no lifted arm

struct NeckCut {
  Plane plane;             // scan frame, its normal towards the head
  Eigen::Vector3d middle;  // of the neck, in the plane
  double radius;           // mean, of the neck
};

NeckCut cut_above(const Points& loop, const Eigen::Vector3d& up, double above) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : loop) middle += point / static_cast<double>(loop.size());
  for (std::size_t i = 0; i < loop.size(); ++i)
    normal += (loop[i] - middle).cross(loop[(i + 1) % loop.size()] - middle);
  if (!(normal.norm() > kLeastArea))
    throw geometry::Refusal(std::string(geometry::refusal::kMissingPart) + ":neck",
                            "the tape of her neck encloses nothing, so her head cannot be cut off");
  normal.normalize();
  if (normal.dot(up) < 0) normal = -normal;
  double radius = 0;
  for (const Eigen::Vector3d& point : loop)
    radius += (point - middle).norm() / static_cast<double>(loop.size());
  middle += above * normal;
  return {Plane(normal, middle), middle, radius};
}

NeckCut neck_of(const geometry::BodyMeasures& measures) {
  const Eigen::Vector3d up = measures.body_from_scan.linear().transpose() * Eigen::Vector3d::UnitZ();
  for (const geometry::GirthLoop& loop : measures.loops)
    if (loop.name == "neck" && loop.points.size() > 2) return cut_above(loop.points, up, kAboveTape);
  Points base;
  for (const char* name : {"neck_front", "neck_side_L", "neck_back", "neck_side_R"})
    if (const geometry::Landmark* point = measures.find_landmark(name)) base.push_back(point->position);
  if (base.size() == 4) return cut_above(base, up, kAboveBase);
  throw geometry::Refusal(
      std::string(geometry::refusal::kMissingPart) + ":neck",
      "where her head begins is not known, so it cannot be cut off: scan her again, or set "
      "the parameter with_head to export all of her");
}

}  // namespace

FitFigures headless(FitFigures figures) {
  const NeckCut neck = neck_of(figures.measures);
  const Eigen::Isometry3d& frame = figures.measures.body_from_scan;
  const Eigen::Vector3d middle = frame * neck.middle;
  const geometry::CutMesh cut =
      geometry::cut_off(figures.body, neck.plane, [&](const std::vector<int>& piece) {
        double top = middle.z();
        Eigen::Vector3d centre = Eigen::Vector3d::Zero();
        for (const int v : piece) {
          const Eigen::Vector3d place = frame * figures.body.vertices[v];
          top = std::max(top, place.z());
          centre += place / static_cast<double>(piece.size());
        }
        return top > middle.z() + kTallerThan && (centre - middle).head<2>().norm() < kReach;
      });
  figures.body = {cut.of(figures.body.vertices), cut.triangles};
  if (cut.triangles.empty())
    throw geometry::Refusal(std::string(geometry::refusal::kMissingPart) + ":neck",
                            "the tape of her neck lies below all of her, so her head cannot be cut off");
  const auto is_over_neck = [&](const Eigen::Vector3d& place) {
    constexpr double kWider = 1.2,
                     kRim = 1e-3;  // than the neck; m, above the cut's own rim, which is in the plane
    const Eigen::Vector3d offset = place - neck.middle, normal = neck.plane.normal();
    const double beyond = normal.dot(offset), above = (frame * place).z() - middle.z();
    return beyond > kRim && above > kTallerThan && (offset - beyond * normal).norm() < kWider * neck.radius;
  };
  if (std::any_of(figures.body.vertices.begin(), figures.body.vertices.end(), is_over_neck))
    throw geometry::Refusal(
        std::string(geometry::refusal::kMissingPart) + ":neck",
        "her head cannot be cut off: its skin goes on into something beside it, such as a hand or an arm. "
        "Scan her again with her arms down, or set the parameter with_head to export all of her");
  figures.deformed = cut.of(figures.deformed);
  figures.in_scan_posture = cut.of(figures.in_scan_posture);
  figures.distortion = cut.of(figures.distortion);
  for (geometry::FitWarning& warning : figures.scan.warnings) {
    std::vector<int> left;
    for (const int v : warning.vertices)
      if (cut.left[v] >= 0) left.push_back(cut.left[v]);
    warning.vertices = std::move(left);
  }
  figures.head = false;
  auto& landmarks = figures.measures.landmarks;
  landmarks.erase(std::remove_if(landmarks.begin(), landmarks.end(),
                                 [&](const geometry::Landmark& landmark) {
                                   return neck.plane.signedDistance(landmark.position) > 0 &&
                                          (landmark.position - neck.middle).norm() < kReach;
                                 }),
                  landmarks.end());
  return figures;
}

}  // namespace tensegric_fit::node
