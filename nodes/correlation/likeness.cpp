#include "correlation/likeness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "correlation/find_measure.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::BodyMeasures;

constexpr double kDegrees = 180 / 3.14159265358979323846;

// From the shoulder point to the middle of the upper arm's tape, where both were found.
std::optional<Vector3d> arm_of(const BodyMeasures& measures, const std::string& side) {
  const geometry::Landmark* shoulder = measures.find_landmark("shoulder_" + side);
  if (shoulder == nullptr) return std::nullopt;
  for (const geometry::GirthLoop& loop : measures.loops) {
    if (loop.name != "upper_arm_" + side || loop.points.empty()) continue;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& p : loop.points) middle += p / static_cast<double>(loop.points.size());
    return (middle - shoulder->position).normalized();
  }
  return std::nullopt;
}

std::optional<double> arm_turn(const BodyMeasures& body, const BodyMeasures& worn,
                               const Isometry3d& body_from_worn, const std::string& side) {
  const auto before = arm_of(body, side), after = arm_of(worn, side);
  if (!before || !after) return std::nullopt;
  return std::acos(std::clamp(before->dot(body_from_worn.linear() * *after), -1.0, 1.0));
}

// The motion that lays landmarks of that name onto each other; `fallback` where fewer than three are in both.
Isometry3d by_landmarks(const BodyMeasures& body, const BodyMeasures& worn,
                        std::initializer_list<const char*> names, const Isometry3d& fallback) {
  std::vector<Vector3d> to, from;
  for (const char* name : names) {
    const geometry::Landmark *a = body.find_landmark(name), *b = worn.find_landmark(name);
    if (a == nullptr || b == nullptr) continue;
    to.push_back(a->position);
    from.push_back(b->position);
  }
  if (to.size() < 3) return fallback;
  const auto columns = [](const std::vector<Vector3d>& points) {
    return Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3,
                                              static_cast<Eigen::Index>(points.size()));
  };
  Isometry3d motion;
  motion.matrix() = Eigen::umeyama(columns(from), columns(to), false);
  return motion;
}

double angle_between(const Isometry3d& a, const Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
}

std::optional<double> residual_of(const Alignment& alignment) {
  if (alignment.status == AlignmentStatus::too_little) return std::nullopt;
  return alignment.residual;
}

// The lesser of the two girths; 0 where neither was measured on both.
double growth_of(const BodyMeasures& body, const BodyMeasures& worn) {
  std::vector<double> growth;
  for (const char* name : {"underbust", "waist"}) {
    const geometry::Measure *before = find_measure(body.girths, name),
                            *after = find_measure(worn.girths, name);
    if (before != nullptr && after != nullptr) growth.push_back(after->metres - before->metres);
  }
  return growth.empty() ? 0 : *std::min_element(growth.begin(), growth.end());
}

}  // namespace

Patch patch_of(const SimulatedBody& body, const std::vector<int>& vertices) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(body.deformed, body.rest.triangles);
  Patch patch;
  for (const int v : vertices) {
    patch.points.push_back(body.deformed[v]);
    patch.normals.push_back(normals[v]);
  }
  return patch;
}

Isometry3d by_body_frames(const SimulatedBody& body, const WornBody& worn) {
  return body.measures.body_from_scan.inverse() * worn.measures.body_from_scan;
}

Likeness likeness_of(const SimulatedBody& body, const std::vector<SkinPart>& parts, const WornBody& worn,
                     const SeenSurface& surface, const Alignment& alignment) {
  const Isometry3d frames = by_body_frames(body, worn);
  const Pieces pieces = pieces_of(body, parts);
  const auto aligned = [&](const std::vector<int>& vertices, const Isometry3d& start) {
    return align(patch_of(body, vertices), surface, start);
  };
  const Alignment chest =
      aligned(pieces.chest, by_landmarks(body.measures, worn.measures,
                                         {"shoulder_L", "shoulder_R", "neck_front", "neck_back",
                                          "neck_side_L", "neck_side_R", "axilla_L", "axilla_R"},
                                         frames));
  const Alignment pelvis = aligned(pieces.pelvis, frames);
  const auto left = residual_of(aligned(pieces.left_shank, frames)),
             right = residual_of(aligned(pieces.right_shank, frames));

  Likeness likeness;
  likeness.still = alignment.residual;
  const geometry::Measure *before = find_measure(body.measures.heights, "stature"),
                          *after = find_measure(worn.measures.heights, "stature");
  if (before != nullptr && after != nullptr) {
    likeness.stature = after->metres - before->metres;
    likeness.stature_half_width = std::hypot(before->half_width, after->half_width);
  }
  likeness.chest = residual_of(chest);
  likeness.pelvis = residual_of(pelvis);
  if (left && right) likeness.shanks = std::max(*left, *right);
  if (likeness.chest && likeness.pelvis)
    likeness.bend = angle_between(chest.patch_from_scan, pelvis.patch_from_scan);
  const Isometry3d& chest_motion = likeness.chest ? chest.patch_from_scan : alignment.patch_from_scan;
  likeness.left_arm = arm_turn(body.measures, worn.measures, chest_motion, "L");
  likeness.right_arm = arm_turn(body.measures, worn.measures, chest_motion, "R");
  likeness.growth = growth_of(body.measures, worn.measures);
  return likeness;
}

void check_same(const Likeness& likeness) {
  namespace refusal = geometry::refusal;
  using geometry::Refusal;
  if (!likeness.chest && !likeness.pelvis)
    throw Refusal(refusal::kTooFewData,
                  "neither chest nor pelvis shows enough skin beside the garment to recognise the body");
  // Over a cropped face or hidden feet the model guesses it; unknown counts as alike.
  const double same_stature = std::max(kSameStature, likeness.stature_half_width);
  const bool as_tall = !(std::abs(likeness.stature) > same_stature);
  if (as_tall && likeness.shanks && *likeness.shanks <= kSameShank && likeness.growth >= kCoat)
    throw Refusal(
        refusal::kCoatOn,
        fmt::format("underbust and waist girths are larger by {:.0f} mm and more, while the lower legs "
                    "match: a coat, other thick clothes, or a body that has grown",
                    1e3 * likeness.growth));
  for (const auto& [name, residual] : {std::pair{"chest", likeness.chest}, {"pelvis", likeness.pelvis}}) {
    if (!residual || *residual <= kSamePiece) continue;
    throw Refusal(
        refusal::kOtherPerson,
        fmt::format("her {} is {:.1f} mm off where the garment leaves it alone, more than {:.0f} mm: "
                    "the worn scan is of somebody else",
                    name, 1e3 * *residual, 1e3 * kSamePiece));
  }
  const std::string again = "; she must stand as in the scan before";
  if (likeness.bend && *likeness.bend > kSameBend)
    throw Refusal(
        refusal::kOtherPose,
        fmt::format("chest and pelvis match by themselves, but the chest is turned by {:.1f} degrees "
                    "against the pelvis, more than {:.0f}{}",
                    *likeness.bend * kDegrees, kSameBend * kDegrees, again));
  if (!as_tall)
    throw Refusal(
        refusal::kOtherPerson,
        fmt::format("her stature is {:+.0f} mm off, more than {:.0f} mm: the worn scan is of somebody "
                    "else",
                    1e3 * likeness.stature, 1e3 * same_stature));
  if (likeness.still > kSameStill)
    throw Refusal(
        refusal::kOtherPerson,
        fmt::format("the skin that the garment leaves alone is {:.1f} mm off, more than {:.0f} mm, though "
                    "she stands alike: the worn scan is of somebody else",
                    1e3 * likeness.still, 1e3 * kSameStill));
  for (const auto& [side, turn] : {std::pair{"left", likeness.left_arm}, {"right", likeness.right_arm}})
    if (turn && *turn > kSameArm)
      throw Refusal(
          refusal::kOtherPose,
          fmt::format("her {} arm points {:.0f} degrees another way, more than {:.0f}, and the breast "
                      "goes along with it{}",
                      side, *turn * kDegrees, kSameArm * kDegrees, again));
}

}  // namespace tensegric_fit::correlation
