#include "geometry/moved_skin.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "geometry/carried_points.hpp"
#include "geometry/section.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOnTape = 1e-4;    // m
constexpr double kSteepest = 0.5;   // of the trunk's outline: change of half-width per change of height
constexpr double kSmallest = 1e-8;  // m^2; a loop enclosing less has no defined plane

/// A tape in its own plane.
class FlatTape {
 public:
  /// has_plane() is false where the loop encloses too little area.
  explicit FlatTape(const std::vector<Vector3d>& loop) {
    if (loop.size() < 3) return;
    for (const Vector3d& p : loop) origin_ += p / static_cast<double>(loop.size());
    Vector3d area = Vector3d::Zero();  // twice the loop's area vector
    for (std::size_t i = 0; i < loop.size(); ++i)
      area += (loop[i] - origin_).cross(loop[(i + 1) % loop.size()] - origin_);
    if (!(area.norm() > kSmallest)) return;
    normal = area.normalized();
    across_ = normal.unitOrthogonal();
    std::vector<Vector2d> flat;
    for (const Vector3d& p : loop) flat.push_back(flattened(p));
    hull_ = convex_hull(std::move(flat));
  }

  bool has_plane() const { return hull_.size() >= 3; }
  double above(const Vector3d& p) const { return normal.dot(p - origin_); }

  /// How far beyond the tape a point lies in its plane; negative inside.
  double outside(const Vector3d& p) const {
    const Vector2d at = flattened(p);
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      const Vector2d along = (hull_[(i + 1) % hull_.size()] - hull_[i]).normalized();
      farthest = std::max(farthest, Vector2d(along.y(), -along.x()).dot(at - hull_[i]));
    }
    return farthest;
  }

  Vector3d normal = Vector3d::Zero();

 private:
  Vector2d flattened(const Vector3d& p) const {
    return {across_.dot(p - origin_), normal.cross(across_).dot(p - origin_)};
  }

  Vector3d origin_ = Vector3d::Zero(), across_ = Vector3d::Zero();
  std::vector<Vector2d> hull_;
};

std::optional<double> girth_change(const MovedSkin& skin, const std::vector<Vector3d>& loop) {
  const std::vector<Vector3d> before = tape_after({skin.before, skin.before.vertices}, loop);
  const std::vector<Vector3d> after = tape_after(skin, loop);
  if (before.empty() || after.empty()) return std::nullopt;
  return length_of(after, true) - length_of(before, true);
}

/// How far a height rises along the body's z with its landmarks, m: their mean; with the fold under the bust,
/// whose height is its lower side's, the lower one. `after`: where measures.landmarks lie then.
std::optional<double> rise(const std::string& height, const BodyMeasures& measures,
                           const std::vector<Vector3d>& after) {
  const std::vector<std::string>& names = landmarks_of_height(height);
  std::vector<double> z_before, z_after;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Landmark& landmark = measures.landmarks[i];
    if (std::find(names.begin(), names.end(), landmark.name) == names.end()) continue;
    z_before.push_back((measures.body_from_scan * landmark.position).z());
    z_after.push_back((measures.body_from_scan * after[i]).z());
  }
  if (z_before.empty()) return std::nullopt;
  const auto of_both = [&](const std::vector<double>& z) {
    return height == "underbust" ? *std::min_element(z.begin(), z.end())
                                 : std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
  };
  return of_both(z_after) - of_both(z_before);
}

double top(const std::vector<Vector3d>& vertices, const Eigen::Isometry3d& body_from_scan) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Vector3d& p : vertices) highest = std::max(highest, (body_from_scan * p).z());
  return highest;
}

}  // namespace

std::vector<Vector3d> in_scan_posture(const TriangleMesh& before, const std::vector<Vector3d>& after,
                                      const BoneFrames& bones) {
  std::vector<Vector3d> back = after;
  if (bones.still()) return back;
  for (std::size_t v = 0; v < back.size(); ++v)
    back[v] = bones.frame_at(before.vertices[v]).inverse() * after[v];
  return back;
}

std::vector<Vector3d> carried(const std::vector<Vector3d>& points, const MovedSkin& skin) {
  return CarriedPoints(skin.before, SurfaceTree(skin.before), points).at(skin.after);
}

std::vector<Vector3d> landmarks_after(const BodyMeasures& measures, const MovedSkin& skin) {
  std::vector<Vector3d> points;
  for (const Landmark& landmark : measures.landmarks) points.push_back(landmark.position);
  return carried(points, skin);
}

std::vector<Vector3d> tape_after(const MovedSkin& skin, const std::vector<Vector3d>& loop) {
  const FlatTape before(loop);
  if (!before.has_plane()) return {};
  std::vector<double> height(skin.after.size());
  for (std::size_t v = 0; v < height.size(); ++v) height[v] = before.above(skin.after[v]);
  std::vector<Vector3d> section;
  for (const Eigen::Vector3i& triangle : skin.before.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      if (height[a] < 0 || height[b] >= 0)
        continue;  // each crossing edge once: the other triangle runs along it upwards
      const double u = height[a] / (height[a] - height[b]);
      const Vector3d was = (1 - u) * skin.before.vertices[a] + u * skin.before.vertices[b];
      if (before.outside(was) <= kOnTape + kSteepest * std::abs(before.above(was)))
        section.push_back((1 - u) * skin.after[a] + u * skin.after[b]);
    }
  }
  if (section.size() < 3) return {};
  return tape(section, before.normal);
}

double ChangedMeasure::change() const {
  return (std::round(1e3 * *after) - std::round(1e3 * before.metres)) / 1e3;
}

std::vector<ChangedMeasure> girths_after(const BodyMeasures& measures, const MovedSkin& skin) {
  std::vector<ChangedMeasure> changed;
  for (const Measure& girth : measures.girths) {
    changed.push_back({girth, std::nullopt});
    for (const GirthLoop& loop : measures.loops)
      if (loop.name == girth.name)
        if (const auto change = girth_change(skin, loop.points))
          changed.back().after = girth.metres + *change;
  }
  return changed;
}

std::optional<ChangedMeasure> bust_points_apart(const BodyMeasures& measures, const MovedSkin& skin) {
  const Landmark *left = measures.find_landmark("bust_point_L"),
                 *right = measures.find_landmark("bust_point_R");
  if (!left || !right) return std::nullopt;
  const std::vector<Vector3d> after = carried({left->position, right->position}, skin);
  return ChangedMeasure{{"bust_points", (left->position - right->position).norm(),
                         std::min(left->confidence, right->confidence), ""},
                        (after[0] - after[1]).norm()};
}

std::vector<ChangedMeasure> heights_after(const BodyMeasures& measures, const MovedSkin& skin) {
  const std::vector<Vector3d> after = landmarks_after(measures, skin);
  std::vector<ChangedMeasure> changed;
  for (const Measure& height : measures.heights) {
    changed.push_back({height, std::nullopt});
    std::optional<double> change = rise(height.name, measures, after);
    if (height.name == "stature")
      change = top(skin.after, measures.body_from_scan) - top(skin.before.vertices, measures.body_from_scan);
    if (change) changed.back().after = height.metres + *change;
  }
  return changed;
}

}  // namespace tensegric_fit::geometry
