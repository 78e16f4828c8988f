/// Posture: bones that carry the body when the trunk twists or leans (P2 §6).
#pragma once

#include <Eigen/Geometry>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::geometry {

/// The chest against the pelvis, radians.
struct Posture {
  double twist = 0;      ///< about the body's vertical; positive turns the chest to her left
  double side_lean = 0;  ///< towards her left
};

inline constexpr double kLargestTwist = 60 * 3.14159265358979323846 / 180;
inline constexpr double kLargestLean = 40 * 3.14159265358979323846 / 180;

/// The spine's position: with a posture it defines the bone frames, and a message carries both.
struct Spine {
  Eigen::Isometry3d body_from_scan = Eigen::Isometry3d::Identity();
  double x = 0, y = 0;             ///< of the upright spine, body frame, metres
  double pelvis = 0, chest = 0.3;  ///< heights between which it bends, metres; pelvis below chest
};

/// The spine passes above the crotch and bends between hip and underbust level.
/// \throw Refusal missing_part:hip, missing_part:underbust, missing_part:crotch; not_a_body: the underbust
/// is not above the hip
Spine spine_of(const BodyMeasures& measures);

/// Pelvis, lumbar spine and chest as frames: one at each height, whose angles grow smoothly from 0 at the hip
/// to the full angles at the underbust. The pelvis and everything below stay, the chest and everything above
/// move as one rigid body, and the spine bends in between at constant length. The motion is continuously
/// differentiable and conserves volumes that are symmetric about the spine; within the limits it inverts
/// nothing that is nearer to the spine than (chest - pelvis) / (1.5 |side_lean|).
class BoneFrames {
 public:
  /// No motion.
  BoneFrames() = default;
  /// \throw Refusal as spine_of; bad_option: an angle beyond its limit
  BoneFrames(const BodyMeasures& measures, const Posture& posture);
  /// \throw Refusal bad_option: an angle beyond its limit, a spine without length
  BoneFrames(const Spine& spine, const Posture& posture);

  /// The posed position of a point in the scan's frame, with `share` of the angles, 0 to 1. Where nothing
  /// moves it is the same point, bit for bit.
  Eigen::Vector3d moved(const Eigen::Vector3d& point, double share = 1) const;

  /// The rigid motion of the bone at that point's height, in the scan's frame: maps the point to moved().
  Eigen::Isometry3d frame_at(const Eigen::Vector3d& point, double share = 1) const;

  bool still() const { return posture_.twist == 0 && posture_.side_lean == 0; }
  const Spine& spine() const { return spine_; }
  const Posture& posture() const { return posture_; }

 private:
  Spine spine_;
  Posture posture_;
};

}  // namespace tensegric_fit::geometry
