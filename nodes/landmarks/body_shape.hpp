/// What every search for landmarks looks at: the body in its own frame, with its sections.
#pragma once

#include <vector>

#include "landmarks/body_levels.hpp"
#include "landmarks/junction.hpp"

namespace tensegric_fit::landmarks {

/// x forward, y left, z up, floor at 0.
struct BodyShape {
  /// `filled` as for find_landmarks.
  explicit BodyShape(geometry::TriangleMesh body_in_its_frame, std::vector<char> filled = {});

  /// Whether the scan saw none of the skin within `radius` of a point: any vertex there is one of a filled
  /// hole.
  bool unseen(const Eigen::Vector3d& point, double radius) const;

  geometry::TriangleMesh mesh;
  std::vector<char> filled;              ///< empty, or one flag a vertex: the scan saw nothing there
  std::vector<Eigen::Vector3d> normals;  ///< area-weighted, unit, one a vertex
  SlicedMesh sliced;
  BodyLevels levels;
  Junction crotch;  ///< of the legs; at `levels.legs_part` or above
  double stature;   ///< the unit of all search windows
};

enum Side { kLeft = 0, kRight = 1 };
inline constexpr double kSign[2] = {1, -1};  ///< of y
inline constexpr const char* kSuffix[2] = {"_L", "_R"};

}  // namespace tensegric_fit::landmarks
