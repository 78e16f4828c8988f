/// The skin that landmarks are looked for on: a mesh in the body's frame, each vertex with its part of the
/// body.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/section.hpp"
#include "geometry/side.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::landmarks {

using geometry::kLeft;
using geometry::kRight;
using geometry::kSides;
using geometry::kSign;
using geometry::kSuffix;
using geometry::Side;

/// x forward, y left, z up, the ground at z = 0; metres.
struct Surface {
  geometry::TriangleMesh mesh;
  std::vector<double> arm;   ///< per vertex: how much of it an arm carries, 0 to 1
  std::vector<char> unseen;  ///< per vertex: 1 where no scan point backs it; empty: all is seen

  /// Whether a triangle belongs to an arm by more than half.
  bool is_arm(const Eigen::Vector3i& t) const { return arm[t[0]] + arm[t[1]] + arm[t[2]] > 3 * 0.5; }
};

using Selected = std::function<bool(const Eigen::Vector3i& triangle)>;

/// What a plane cuts of the selected triangles; loops name triangles of the surface.
std::vector<geometry::SectionLoop> cut(const Surface& surface, const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& normal, const Selected& selected);

/// The trunk, legs and head: all but the triangles of arms.
class Trunk {
 public:
  /// \throw Refusal bad_mesh: higher than 10 m
  explicit Trunk(Surface surface);
  bool operator()(const Eigen::Vector3i& triangle) const;

  /// Level sections, however many are asked for: only triangles near the height are looked at.
  std::vector<geometry::SectionLoop> level(double height) const;
  /// The tape round all loops at a height, breasts that hang below their fold included; empty where there is
  /// no trunk.
  std::vector<Eigen::Vector3d> tape(double height) const;
  /// The tape round the trunk's own loop, the widest.
  std::vector<Eigen::Vector3d> tape_of_torso(double height) const;
  const Surface& surface() const { return surface_; }

 private:
  Surface surface_;
  double bottom_ = 0;
  std::vector<std::vector<int>> triangles_in_;  ///< of each slab: those that reach into it
};

/// A line over the skin in even steps.
struct Profile {
  static constexpr double kStep = 0.001;  ///< m
  std::vector<Eigen::Vector3d> points;
  std::vector<double> curvature;  ///< 1/m, per point: positive where the skin is hollow
};

/// The trunk's sagittal profile from the place nearest to `start` downwards for `length` metres; empty where
/// there is none. Noise is smoothed away over some 4 mm.
Profile profile_down(const Trunk& trunk, const Eigen::Vector3d& start, double length);

/// Share of the vertices within `radius` of a point that no scan point backs; where there are none (a coarse
/// mesh), that of the nearest vertex, 0 or 1.
double unseen_share(const Surface& surface, const Eigen::Vector3d& point, double radius);

/// Vertices within `radius` of a point for which `wanted` holds.
std::vector<int> vertices_near(const Surface& surface, const Eigen::Vector3d& point, double radius,
                               const std::function<bool(int)>& wanted);

}  // namespace tensegric_fit::landmarks
