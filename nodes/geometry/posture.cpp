#include "geometry/posture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// Gauss-Legendre quadrature, 6 points on [0, 1]: exact to rounding for angles within the limits.
constexpr double kNode[] = {0.033765242898423975, 0.16939530676686776, 0.38069040695840156,
                            0.61930959304159844,  0.83060469323313224, 0.96623475710157603};
constexpr double kWeight[] = {0.085662246189585178, 0.18038078652406930, 0.23395696728634552,
                              0.23395696728634552,  0.18038078652406930, 0.085662246189585178};

void check_angle(double value, double limit, const char* name) {
  if (!(std::abs(value) <= limit))
    throw Refusal(refusal::kBadOption, std::string(name) + " is " + std::to_string(value) +
                                           " rad, beyond the limit of " + std::to_string(limit));
}

// Share of the angles that the spine has turned by at share `up` of its length from pelvis to chest.
double turned(double up) {
  return up * up * (3 - 2 * up);
}

// Position on a spine of length 1 that leans by `lean` in all, at share `up` of its length from the pelvis.
Vector3d way_up(double up, double lean) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double angle = lean * turned(up * kNode[i]);
    sum += up * kWeight[i] * Vector3d(0, std::sin(angle), std::cos(angle));
  }
  return sum;
}

}  // namespace

Spine spine_of(const BodyMeasures& measures) {
  Spine spine;
  spine.body_from_scan = measures.body_from_scan;
  spine.pelvis = measures.height("hip");
  spine.chest = measures.height("underbust");
  const Vector3d crotch = measures.body_from_scan * measures.landmark("crotch");
  spine.x = crotch.x();
  spine.y = crotch.y();
  if (!(spine.chest > spine.pelvis))
    throw Refusal(refusal::kNotABody, "the underbust is not above the hip: no spine to bend");
  return spine;
}

BoneFrames::BoneFrames(const BodyMeasures& measures, const Posture& posture)
    : BoneFrames(spine_of(measures), posture) {}

BoneFrames::BoneFrames(const Spine& spine, const Posture& posture) : spine_(spine), posture_(posture) {
  check_angle(posture.twist, kLargestTwist, "twist");
  check_angle(posture.side_lean, kLargestLean, "side_lean");
  if (!spine.body_from_scan.matrix().allFinite() || !std::isfinite(spine.x + spine.y + spine.pelvis) ||
      !std::isfinite(spine.chest) || !(spine.chest > spine.pelvis))
    throw Refusal(refusal::kBadOption, "the spine's pelvis must lie below its chest");
}

Isometry3d BoneFrames::frame_at(const Vector3d& point, double share) const {
  const double height = (spine_.body_from_scan * point).z(), length = spine_.chest - spine_.pelvis;
  const double up = std::min((height - spine_.pelvis) / length, 1.0);
  if (!(up > 0) || share == 0 || still()) return Isometry3d::Identity();
  const double lean = share * posture_.side_lean;
  const Vector3d axis(spine_.x, spine_.y, spine_.pelvis);
  Isometry3d bone = Isometry3d::Identity();
  bone.translate(axis + length * way_up(up, lean));
  bone.rotate(AngleAxisd(-lean * turned(up), Vector3d::UnitX()));
  bone.rotate(AngleAxisd(share * posture_.twist * turned(up), Vector3d::UnitZ()));
  bone.translate(-axis - Vector3d(0, 0, up * length));
  return spine_.body_from_scan.inverse() * bone * spine_.body_from_scan;
}

Vector3d BoneFrames::moved(const Vector3d& point, double share) const {
  const Isometry3d frame = frame_at(point, share);
  return frame.matrix().isIdentity(0) ? point : frame * point;
}

}  // namespace tensegric_fit::geometry
