#include "correlation/align.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "correlation/skin_parts.hpp"
#include "geometry/enum_words.hpp"
#include "geometry/rigid_motion.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::SmallMotion;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// Why not the assembler's registration: one patch against one surface with its holes, of which a share of the
// nearest matches is kept, and which may leave the motion undetermined; columns are points, weighted, all in
// one system.
constexpr std::size_t kPoints = 2500;
constexpr int kMostSteps = 80;
constexpr double kKept = 0.8;       // share of the matches
constexpr double kLastStep = 1e-6;  // m, at the patch's own distance from its middle
constexpr double kLoosest = 1e-5;   // least / greatest eigenvalue of a system that says where the patch is

struct Match {
  double distance;
  Vector3d on_patch, on_scan, normal;  // frame of the patch
};

std::vector<Match> matches_of(const Patch& patch, const SeenSurface& scan, const Isometry3d& motion) {
  const Isometry3d to_scan = motion.inverse();
  const std::size_t stride = 1 + patch.points.size() / kPoints;
  std::vector<Match> matches;
  for (std::size_t i = 0; i < patch.points.size(); i += stride) {
    const SeenSurface::Place place = scan.nearest(to_scan * patch.points[i]);
    const Vector3d normal = motion.linear() * place.normal, on_scan = motion * place.position;
    if (!place.seen || normal.dot(patch.normals[i]) < kAlike) continue;
    matches.push_back({(on_scan - patch.points[i]).norm(), patch.points[i], on_scan,
                       (normal + patch.normals[i]).normalized()});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.distance < b.distance; });
  return matches;
}

// Distance below which the kept share of the matches lies. \pre sorted, not empty
double kept_distance(const std::vector<Match>& matches) {
  return matches[static_cast<std::size_t>(kKept * static_cast<double>(matches.size() - 1))].distance;
}

struct Step {
  Isometry3d motion;
  double length;    // m
  bool determined;  // by the matches
};

Step step_from(const std::vector<Match>& matches) {
  const auto kept = static_cast<std::size_t>(kKept * static_cast<double>(matches.size()));
  Vector3d middle = Vector3d::Zero();
  for (std::size_t i = 0; i < kept; ++i) middle += matches[i].on_scan / static_cast<double>(kept);
  double squares = 0;
  for (std::size_t i = 0; i < kept; ++i) squares += (matches[i].on_scan - middle).squaredNorm();
  const double size = std::sqrt(squares / static_cast<double>(kept));

  Matrix6d system = Matrix6d::Zero();  // of the turn, in units of `size`, and the shift
  SmallMotion right = SmallMotion::Zero();
  for (std::size_t i = 0; i < kept; ++i) {
    const Match& match = matches[i];
    SmallMotion row = geometry::along_normal(match.on_scan, middle, match.normal);
    row.head<3>() /= size;
    system += row * row.transpose();
    right += row * match.normal.dot(match.on_patch - match.on_scan);
  }
  const Eigen::Matrix<double, 6, 1> eigenvalues =
      Eigen::SelfAdjointEigenSolver<Matrix6d>(system, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(eigenvalues[0] > kLoosest * eigenvalues[5])) return {Isometry3d::Identity(), 0, false};
  const SmallMotion step = system.ldlt().solve(right);
  return {geometry::motion_about(middle, step.head<3>() / size, step.tail<3>()), step.norm(), true};
}

}  // namespace

std::string to_string(AlignmentStatus status) {
  static constexpr geometry::EnumWords<AlignmentStatus, 4> kWords{
      {"converged", "capped", "undetermined", "too_little"}};
  return kWords.of(status);
}

Alignment align(const Patch& patch, const SeenSurface& scan, const Isometry3d& start) {
  Alignment alignment;
  alignment.patch_from_scan = start;
  for (;;) {
    const std::vector<Match> matches = matches_of(patch, scan, alignment.patch_from_scan);
    if (matches.size() < kFewestMatches) {
      alignment.status = AlignmentStatus::too_little;
      return alignment;
    }
    alignment.residual = kept_distance(matches);
    if (alignment.status == AlignmentStatus::converged) return alignment;
    alignment.status = AlignmentStatus::capped;
    if (alignment.steps == kMostSteps) return alignment;
    const Step step = step_from(matches);
    if (!step.determined) {
      alignment.status = AlignmentStatus::undetermined;
      return alignment;
    }
    alignment.patch_from_scan = step.motion * alignment.patch_from_scan;
    ++alignment.steps;
    if (step.length < kLastStep) alignment.status = AlignmentStatus::converged;
  }
}

}  // namespace tensegric_fit::correlation
