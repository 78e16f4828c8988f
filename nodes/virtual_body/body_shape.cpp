#include "virtual_body/body_shape.hpp"

#include <algorithm>
#include <cmath>

#include "virtual_body/body_sections.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

// The reference body, metres: stature 1.70 m, every other parameter 1 or 0.
constexpr double kReferenceStature = 1.70;
constexpr double kUpperArm = 0.270;  // shoulder joint to elbow
constexpr double kElbowFlexion = 0.45;
constexpr double kMiddle = 0.04, kThroat = 0.065;  // x about which trunk and neck are thick or thin
constexpr double kLeg = 0.096;                     // y about which a leg is
constexpr double kThighGap = 0.0008;               // half of what is left between thighs that touch
const Vector3d kShoulderJoint(0.008, 0.168, 1.330);
const Vector3d kCollarbone(0.008, 0.02, 1.340);  // its inner end, as far as the shoulder turns about it
const Vector3d kAcromion(-0.018, 0.189, 1.352);  // its outer edge, 10 mm under the skin
// Up to this angle (rad) an arm is raised without its shoulder blade; beyond, the blade turns with it by a
// third (scapulohumeral rhythm: Inman, Saunders and Abbott 1944), and the collarbone by this share.
constexpr double kSettingPhase = 0.5, kCollarboneShare = 0.12;
const Vector3d kChest(0.144, 0.088, 1.236);  // the chest wall under a breast
constexpr double kCrease = 0.014;            // over which the skin under the breast is rounded
const Vector3d kCrotch(0.014, 0, 0.7940);
const Vector3d kBelly(0.060, 0, 1.010);

double bell(double t) {
  return std::exp(-t * t);
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vector3d on_left(const Vector3d& p) {
  return {p.x(), std::abs(p.y()), p.z()};
}

// y of a leg's axis at that height of a body of that thickness: hips grow outwards, thighs to both sides.
double leg_axis(double z, double girth) {
  return kLeg * (1 + (0.2 + 0.8 * smooth_step((z - 0.78) / 0.10)) * (girth - 1));
}

double middle_at(double z) {
  return kMiddle + (kThroat - kMiddle) * smooth_step((z - 1.36) / 0.06);
}

// Across neck and shoulders she is broadest behind, where the trapezius lies: by how much she is broader at
// a point than on average.
double trapezius(const Vector3d& p) {
  const double share = smooth_step((p.z() - 1.37) / 0.06) - smooth_step((p.z() - 1.43) / 0.05);
  return 1 - 0.5 * share * std::clamp((p.x() - 0.015) / 0.055, -1.0, 1.0);
}

Spine spine_of(double stoop) {
  // The chest bends forward; the neck gives half of it back, for she looks ahead
  return Spine({{0.98, 1.30, 0.0, stoop}, {1.43, 1.52, 0.04, -0.5 * stoop}});
}

}  // namespace

BodyShape::BodyShape(const BodyParameters& parameters)
    : scale_(parameters.stature / kReferenceStature),
      build_(parameters.build),
      waist_(parameters.waist),
      hip_(parameters.hip),
      belly_(parameters.belly),
      navel_(0.139 + 0.075 * parameters.belly, 0, 1.050),
      arm_thickness_(1 + 0.7 * (parameters.build - 1)),
      spine_(spine_of(parameters.stoop)),
      torso_(torso_sections(), 0.05),
      leg_(leg_sections(), 0.03),
      upper_arm_(upper_arm_sections(), 0.06),
      forearm_(forearm_sections(), 0.04) {
  for (const double side : {0.5, -0.5})
    breasts_.emplace_back(thickened(kChest), parameters.bust * (1 + side * parameters.asymmetry),
                          1 - parameters.firmness);
  // Arms hang from the shoulders and do not turn with the chest. Collarbones hardly grow with weight.
  Vector3d joint = thickened(kShoulderJoint);
  joint.y() = kShoulderJoint.y() + arms_set_out() / scale_;
  // and go up with a raised arm
  const Eigen::AngleAxisd raised(kCollarboneShare * std::max(0.0, parameters.arm_angle - kSettingPhase),
                                 Vector3d::UnitX());
  joint = kCollarbone + raised * (joint - kCollarbone);
  const Eigen::Isometry3d shoulder =
      Eigen::Translation3d(spine_.bent(joint)) *
      Eigen::Isometry3d(Eigen::AngleAxisd(parameters.arm_angle, Vector3d::UnitX()));
  const Eigen::Isometry3d elbow = shoulder * Eigen::Translation3d(0, 0, -kUpperArm) *
                                  Eigen::AngleAxisd(-kElbowFlexion, Vector3d::UnitY());
  upper_arm_from_body_ = shoulder.inverse();
  forearm_from_body_ = elbow.inverse();
  armpit_ = armpit_height();
}

double BodyShape::thickness(double z) const {
  // Fat sits on the trunk, less on hips, thighs, shoulders and neck, hardly on shins, not on the head
  const double share = 0.25 + 0.45 * smooth_step((z - 0.10) / 0.70) + 0.3 * smooth_step((z - 0.88) / 0.18) -
                       0.4 * smooth_step((z - 1.25) / 0.14) - 0.6 * smooth_step((z - 1.44) / 0.12);
  const double hips = 1 + (hip_ - 1) * bell((z - 0.87) / 0.16);
  const double waist = 1 + (waist_ - 1) * bell((z - 1.08) / 0.085);
  return hips * waist * (1 + (build_ - 1) * share);
}

Vector3d BodyShape::thickened(const Vector3d& p) const {
  const double girth = thickness(p.z()), middle = middle_at(p.z());
  return {middle + girth * (p.x() - middle), girth * p.y(), p.z()};
}

double BodyShape::breasts(const Vector3d& p) const {
  return smooth_union(breasts_[0].value(p), breasts_[1].value(mirrored(p)), 0.020);
}

double BodyShape::trunk_without_breasts(const Vector3d& p) const {
  const double girth = thickness(p.z()), middle = middle_at(p.z());
  const Vector3d q(middle + (p.x() - middle) / girth, p.y() / girth, p.z());
  const auto leg = [&](double side) {
    return leg_({q.x(), kLeg + (side * p.y() - leg_axis(p.z(), girth)) / girth, q.z()});
  };
  const double legs = smooth_union(leg(1), leg(-1), 0.010), broad = trapezius(q);
  const auto buttock = [&q](double side) {
    return ellipsoid(q - Vector3d(-0.018, side * 0.068, 0.885), {0.078, 0.072, 0.085});
  };
  double d = smooth_union(torso_({q.x(), q.y() / broad, q.z()}), legs, 0.035);
  d = smooth_union(d, smooth_union(buttock(1), buttock(-1), 0.012), 0.040);
  if (belly_ > 0) d = smooth_union(d, ellipsoid(q - kBelly, {navel_.x() - kBelly.x(), 0.125, 0.125}), 0.060);
  // The spine's lowest neck vertebra, unless fat hides it
  d -= 0.003 * bell((build_ - 1) / 0.2) * bell((q - Vector3d(-0.038, 0, 1.422)).norm() / 0.014);
  d += 0.006 * bell((q - navel_).norm() / 0.009);
  // The perineum, level from front to back between the thighs, and the pubis before it: bones do not thicken
  const Vector3d r = p - thickened(kCrotch) + kCrotch;
  const double perineum = tapered_capsule(r, {-0.022, 0, 0.8175}, {0.070, 0, 0.8165}, 0.020, 0.020),
               pubis = tapered_capsule(r, {0.070, 0, 0.8200}, {0.090, 0, 0.870}, 0.020, 0.034);
  // Thighs that touch are apart all the same, up to the perineum and somewhat higher before it
  const double roof = kCrotch.z() + 0.026 * smooth_step((r.x() - 0.075) / 0.03);
  d = std::max(d * girth, std::min(kThighGap - std::abs(p.y()), roof - p.z()));
  return smooth_union(d, smooth_union(perineum, pubis, 0.010), 0.020);
}

double BodyShape::trunk(const Vector3d& p) const {
  // A crease under the breast, a gentle slope above it
  const double level = (breasts_[0].centre().z() + breasts_[1].centre().z()) / 2 - 0.02;
  const double k = kCrease + 0.050 * smooth_step((p.z() - level) / 0.10);
  return smooth_union(trunk_without_breasts(p), breasts(p), k);
}

double BodyShape::arm(const Vector3d& p) const {
  const auto thick = [](const Loft& limb, Vector3d q, double thickness) {
    q.head<2>() /= thickness;
    return thickness * limb(q);
  };
  const Vector3d upper = upper_arm_from_body_ * p, fore = forearm_from_body_ * p;
  const double palm = ellipsoid(fore - Vector3d(0.004, 0, -0.290), {0.040, 0.017, 0.058});
  const double fingers = ellipsoid(fore - Vector3d(0.000, -0.006, -0.365), {0.034, 0.012, 0.062});
  const double thumb = tapered_capsule(fore, {0.020, -0.004, -0.270}, {0.062, -0.014, -0.335}, 0.014, 0.009);
  double d = smooth_union(thick(upper_arm_, upper, arm_thickness_),
                          thick(forearm_, fore, (1 + arm_thickness_) / 2), 0.030);
  d = smooth_union(d, palm, 0.025);
  d = smooth_union(d, fingers, 0.015);
  return smooth_union(d, thumb, 0.012);
}

double BodyShape::trunk_and_arm(const Vector3d& p) const {
  const Vector3d upright = spine_.straightened(p);
  const double k = 0.024 + 0.036 * smooth_step((upright.z() - 1.27) / 0.08);  // sharper in the armpit
  return smooth_union(trunk(upright), arm(on_left(p)), k);
}

double BodyShape::armpit_height() const {
  const Eigen::Isometry3d body_from_arm = upper_arm_from_body_.inverse();
  const Vector3d joint = body_from_arm.translation(), bone = -body_from_arm.linear().col(2);
  const auto open = [&](double z) {
    const double out = joint.y() + (z - joint.z()) / bone.z() * bone.y();
    for (double y = 0.10; y < out; y += 0.001)
      if (trunk_and_arm({joint.x(), y, z}) > 0) return true;
    return false;
  };
  double low = joint.z() - 0.18, high = joint.z() + 0.02;
  while (high - low > 0.0002) {
    const double middle = (low + high) / 2;
    (open(middle) ? low : high) = middle;
  }
  return low;
}

// The muscles before and behind an armpit run from chest and back to the arm: over its roof the arm is one
// with the trunk for nearly all its depth within some 15 mm, whether she is slim or heavy.
double BodyShape::armpit_folds(const Vector3d& p) const {
  constexpr double kRound = 0.006, kRoofBelow = 0.007, kVault = 0.012,
                   kLowestBehind = 0.16;  // m, m, m, share
  const Vector3d joint = upper_arm_from_body_.inverse().translation(), arm = upper_arm_from_body_ * p;
  const double half_depth = 0.050 * arm_thickness_, roof = armpit_ - kRoofBelow,
               half_height = std::max(joint.z() - roof, 0.04) / 2;
  const double ahead = (p.x() - joint.x()) / half_depth, vault = kVault * std::pow(ahead + kLowestBehind, 2);
  const Eigen::Array2d out = (Eigen::Array2d(ahead * half_depth, p.z() - roof - vault - half_height).abs() -
                              Eigen::Array2d(half_depth, half_height) + kRound);
  const double across = out.max(0).matrix().norm() + std::min(out.maxCoeff(), 0.0) - kRound;
  return std::max(across, arm.y());
}

double BodyShape::head(const Vector3d& p) const {
  const double cranium = ellipsoid(p - Vector3d(0.052, 0, 1.603), {0.098, 0.076, 0.097});
  const double face = ellipsoid(p - Vector3d(0.086, 0, 1.562), {0.060, 0.058, 0.074});
  const double fat = std::max(0.0, build_ - 1);  // under the chin
  const double jaw =
      ellipsoid(p - Vector3d(0.100, 0, 1.520 - 0.024 * fat), {0.050, 0.044, 0.028 + 0.024 * fat});
  const double nose = tapered_capsule(p, {0.142, 0, 1.585}, {0.156, 0, 1.550}, 0.006, 0.010);
  return smooth_union(smooth_union(smooth_union(cranium, face, 0.030), jaw, 0.020), nose, 0.012);
}

double BodyShape::reference_value(const Vector3d& p) const {
  const Vector3d left = on_left(p), upright = spine_.straightened(p);
  double d = smooth_union(trunk_and_arm(p), armpit_folds(left), 0.012);
  d = smooth_union(d, head(upright), 0.018);
  const double heel = ellipsoid(left - Vector3d(0.021, 0.104, 0.031), {0.040, 0.034, 0.046});
  const double sole = ellipsoid(left - Vector3d(0.095, 0.110, 0.018), {0.098, 0.043, 0.028});
  const double instep = tapered_capsule(left, {0.035, 0.104, 0.085}, {0.120, 0.108, 0.020}, 0.034, 0.020);
  const double foot = smooth_union(smooth_union(heel, sole, 0.03), instep, 0.03);
  // Soles are flat under her weight and round off at their edges
  return smooth_intersection(smooth_union(d, foot, 0.02), -p.z(), 0.010);
}

double BodyShape::value(const Vector3d& p) const {
  return scale_ * reference_value(p / scale_);
}

Eigen::AlignedBox3d BodyShape::half_box() const {
  // Room for the arms and for a head that is carried ahead
  constexpr double kFingertips = 0.430;  // below the elbow
  const Vector3d elbow = forearm_from_body_.inverse().translation(),
                 tips = forearm_from_body_.inverse() * Vector3d(0, 0, -kFingertips),
                 crown = spine_.bent({0.15, 0, 1.70});
  Eigen::AlignedBox3d box(Vector3d(-0.18, 0, 0), Vector3d(0.42, 0.45, 1.74));
  for (const Vector3d& p : {elbow, tips, crown}) {
    box.extend(p + Vector3d(0.08, 0.08, 0));
    box.extend(p - Vector3d(0.08, 0, 0));
  }
  // Bellies and buttocks
  box.extend(Vector3d(0.05 - 0.15 * build_ * hip_, 0, 0));
  box.extend(Vector3d(0.05 + (0.25 + 0.1 * belly_) * build_ * hip_ * waist_, 0, 0));
  return {Vector3d(scale_ * box.min()), Vector3d(scale_ * box.max())};
}

Vector3d BodyShape::exit_point(const Vector3d& inside, const Vector3d& direction, double reach) const {
  double near = 0, far = reach;
  constexpr int steps = 300;
  for (int i = 1; i <= steps; ++i) {
    far = reach * i / steps;
    if (value(inside + far * direction) > 0) break;
    near = far;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = (near + far) / 2;
    (value(inside + middle * direction) > 0 ? far : near) = middle;
  }
  return inside + near * direction;
}

bool BodyShape::is_arm(const Vector3d& p) const {
  const Vector3d q = p / scale_;
  return arm(on_left(q)) < trunk(spine_.straightened(q));
}

bool BodyShape::is_under_breast(const Vector3d& p) const {
  const Vector3d q = spine_.straightened(p / scale_);
  return std::abs(trunk_without_breasts(q) - breasts(q)) < kCrease;
}

Vector3d BodyShape::posed(const Vector3d& reference) const {
  return scale_ * spine_.bent(thickened(reference));
}

Vector3d BodyShape::posed_bone(const Vector3d& reference) const {
  return scale_ * spine_.bent(reference);
}

Vector3d BodyShape::posed_direction(const Vector3d& reference, const Vector3d& direction) const {
  return spine_.bent_direction(reference, direction);
}

Vector3d BodyShape::upright(const Vector3d& p) const {
  return scale_ * spine_.straightened(p / scale_);
}

Ray BodyShape::breast_axis(bool left) const {
  const Breast& breast = breasts_[left ? 0 : 1];
  const Vector3d origin = left ? breast.inside() : mirrored(breast.inside()),
                 forward = left ? breast.forward() : mirrored(breast.forward());
  return {scale_ * spine_.bent(origin), spine_.bent_direction(origin, forward)};
}

Ray BodyShape::upper_arm_axis(bool left) const {
  const Eigen::Isometry3d body_from_arm = upper_arm_from_body_.inverse();
  const Vector3d origin = scale_ * body_from_arm.translation(), down = -(body_from_arm.linear().col(2));
  return left ? Ray{origin, down} : Ray{mirrored(origin), mirrored(down)};
}

double BodyShape::arms_set_out() const {
  return scale_ * 0.25 * (build_ - 1) * kShoulderJoint.y();
}

Vector3d BodyShape::acromion(bool left) const {
  const double held_out = std::acos(std::clamp(-upper_arm_axis(true).direction.z(), -1.0, 1.0));
  const double raised = std::max(0.0, held_out - kSettingPhase);
  const Eigen::AngleAxisd collarbone(kCollarboneShare * raised, Vector3d::UnitX()),
      blade(raised / 3, Vector3d::UnitX());
  // A deeper chest carries it back, a broader one does not carry it outwards.
  const Vector3d at_rest(thickened(kShoulderJoint).x(), kShoulderJoint.y(), kShoulderJoint.z());
  const Vector3d joint = kCollarbone + collarbone * (at_rest - kCollarbone);
  const Vector3d p = scale_ * spine_.bent(joint + blade * (kAcromion - kShoulderJoint));
  return left ? p : mirrored(p);
}

Ray BodyShape::neck_axis() const {
  const Vector3d origin(0.030, 0, 1.4635);
  return {posed(origin), posed_direction(origin, Vector3d(0.390, 0, 0.921))};
}

}  // namespace tensegric_fit::virtual_body
