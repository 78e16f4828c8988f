/// The body's skin around a line, and ways over it. Metres, scan frame.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/surface_tree.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::tffd {

class SkinNear {
 public:
  /// \throw Refusal bad_garment: `line` lies nowhere near the body
  SkinNear(const geometry::TriangleMesh& body, const std::vector<Eigen::Vector3d>& line);

  geometry::SurfacePoint nearest(const Eigen::Vector3d& q) const { return tree_.nearest(q); }
  /// \throw Refusal bad_garment: `q` is more than 30 mm away from the skin
  geometry::SurfacePoint below(const Eigen::Vector3d& q) const;

  const Eigen::Vector3i& corners(const geometry::SurfacePoint& at) const {
    return skin_.triangles[at.triangle];
  }
  Eigen::Vector3d normal(const geometry::SurfacePoint& at) const;

  /// The point `way` metres from `from`, towards `direction`.
  geometry::SurfacePoint march(geometry::SurfacePoint from, const Eigen::Vector3d& direction,
                               double way) const;

  /// The shortest way from end to end of `way` beside it, in steps of some 3 mm. \throw Refusal
  /// bad_garment: it has no length, or one beyond kLongestLine
  std::vector<geometry::SurfacePoint> shortest(std::vector<Eigen::Vector3d> way) const;

 private:
  SkinNear(const geometry::TriangleMesh& body, const std::vector<char>& close);

  geometry::TriangleMesh skin_;
  std::vector<Eigen::Vector3d> normals_;
  geometry::SurfaceTree tree_;
};

inline constexpr double kFarFromSkin = 0.030;  ///< m
inline constexpr double kLongestLine = 100;    ///< m: more than any garment has; memory is by length
inline constexpr double kLineSpacing = 0.003;  ///< m, between points along a fibre while it is laid

/// Points along a polyline, as far apart or less. \throw Refusal bad_garment: it is shorter than
/// kLineSpacing, or longer than kLongestLine
std::vector<Eigen::Vector3d> evenly(const std::vector<Eigen::Vector3d>& line, double spacing = kLineSpacing);

}  // namespace tensegric_fit::tffd
