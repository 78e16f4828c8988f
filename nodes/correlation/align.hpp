/// One body laid onto another scan of it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "correlation/seen_surface.hpp"

namespace tensegric_fit::correlation {

/// Points of a skin with its unit normals, metres.
struct Patch {
  std::vector<Eigen::Vector3d> points, normals;
};

/// converged: the last step was below a micrometre. capped: it was not, after as many steps as are allowed.
/// undetermined: the skin can slide or turn on itself. too_little: fewer than kFewestMatches points find skin
/// that the scan saw.
enum class AlignmentStatus { converged, capped, undetermined, too_little };
std::string to_string(AlignmentStatus status);

inline constexpr int kFewestMatches = 200;

struct Alignment {
  Eigen::Isometry3d patch_from_scan = Eigen::Isometry3d::Identity();  ///< takes the scan to the patch's frame
  AlignmentStatus status = AlignmentStatus::too_little;
  int steps = 0;
  double residual = 0;  ///< m; 80 % of the matched points are nearer than this to the scanned skin
};

/// Rigid motion that lays the scan onto the patch: iterative closest points, to planes (Chen and Medioni
/// 1992; the plane's normal is the mean of both skins'), trimmed to the nearest 80 % (Chetverikov et al.
/// 2002), so that a fifth of the patch may have moved or be hidden. Of a large patch, some thousand points
/// evenly by their order. Matches count where both skins face alike within 60 degrees and the scan saw skin.
/// Same input, same bits.
Alignment align(const Patch& patch, const SeenSurface& scan, const Eigen::Isometry3d& start);

}  // namespace tensegric_fit::correlation
