/// What is known about a body: landmarks, heights, girths.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// Names of all landmarks that a body may have.
inline constexpr std::array kLandmarkNames{
    "bust_point_L", "bust_point_R", "underbust_L",  "underbust_R", "shoulder_L",     "shoulder_R",
    "neck_front",   "neck_back",    "neck_side_L",  "neck_side_R", "axilla_L",       "axilla_R",
    "crotch",       "navel",        "buttock_L",    "buttock_R",   "gluteal_fold_L", "gluteal_fold_R",
    "hip_side_L",   "hip_side_R",   "waist_side_L", "waist_side_R"};

/// Is it one of kLandmarkNames?
bool is_landmark(const std::string& name);

/// A point on the body, in the scan's frame, metres. Confidence 0 to 1; `reason` says why when it is below
/// 0.5. Its name is one of kLandmarkNames.
struct Landmark {
  std::string name;
  Eigen::Vector3d position;
  double confidence;
  std::string reason;
  double half_width = 0;  ///< m, radius of the 95 % confidence ball; 0: unknown
};

/// Confidences below come with a reason: the half-width is wider than one and a half times ISO 20685's limit.
inline constexpr double kUnsure = 0.5;

/// A height above the soles or a girth, metres. Heights: bust, underbust, waist, hip, crotch, neck, stature.
/// Girths: bust, underbust, waist, hip, neck, and where found upper_arm_L/R, thigh_L/R.
struct Measure {
  std::string name;
  double metres;
  double confidence;
  std::string reason;
  double half_width = 0;  ///< m, of the 95 % confidence interval; 0: unknown

  bool is_unsure() const { return confidence < kUnsure; }
};

/// The tape along which a girth was measured: a closed loop in the scan's frame.
struct GirthLoop {
  std::string name;
  std::vector<Eigen::Vector3d> points;
};

/// What was not found, and why: a landmark, height or girth by its name (a height and the girth on its level
/// have one), or a part of the body.
struct Missing {
  std::string name, reason;
};

/// Names after ISO 8559-1; definitions in the README of the landmarks.
struct BodyMeasures {
  /// Transforms the scan's frame to the body's (REP 103: x forward, y to her left, z up, origin on the floor
  /// between the feet).
  Eigen::Isometry3d body_from_scan = Eigen::Isometry3d::Identity();
  std::vector<Landmark> landmarks;
  std::vector<Measure> heights;
  std::vector<Measure> girths;
  std::vector<GirthLoop> loops;
  std::vector<Missing> missing;

  /// Null where the landmark was not found.
  const Landmark* find_landmark(const std::string& name) const;
  /// Position in the scan's frame. \throw Refusal missing_part:NAME
  const Eigen::Vector3d& landmark(const std::string& name) const;
  /// Height above the soles. \throw Refusal missing_part:NAME
  double height(const std::string& name) const;
};

/// What is missing of the body itself. A limb and its girth have one name: that girth's own entry, the first
/// of its name where it was not measured, is left out like those of landmarks and heights.
std::vector<Missing> missing_parts(const BodyMeasures& measures);

/// The landmarks that define a height; none of the stature.
const std::vector<std::string>& landmarks_of_height(const std::string& height);

}  // namespace tensegric_fit::geometry
