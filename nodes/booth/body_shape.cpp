#include "booth/body_shape.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::booth {
namespace {

using Eigen::Vector3d;

// The reference body, metres: stature 1.70 m, every other parameter 1 or 0.
constexpr double kReferenceStature = 1.70;
constexpr double kUpperArm = 0.270;  // shoulder joint to elbow
constexpr double kElbowFlexion = 0.45;
const Vector3d kShoulderJoint(0.008, 0.165, 1.330);
const Vector3d kBreastCentre(0.100, 0.088, 1.236);
const Vector3d kBreastReach(0.080, 0.056, 0.062);  // forward, sideways, down
constexpr double kBreastUp = 0.100;                // reach upwards: a drop, not a ball
constexpr double kBreastOutward = 0.28;            // radians
constexpr double kBreastSlope = 0.60;              // how fast its upper half recedes towards the collarbone
constexpr double kBreastSag = 0.045;               // how far the tip sinks without any firmness
constexpr double kNippleHeight = 0.005, kNippleWidth = 0.006;

std::vector<Section> torso_sections() {
  // z, back, front, right, left, exponent: from between the thighs to the neck inside the head
  return {{0.799, -0.036, 0.036, -0.090, 0.090, 2.0}, {0.840, -0.050, 0.100, -0.145, 0.145, 2.2},
          {0.880, -0.062, 0.114, -0.163, 0.163, 2.3}, {0.920, -0.066, 0.124, -0.166, 0.166, 2.4},
          {0.960, -0.060, 0.130, -0.160, 0.160, 2.4}, {1.000, -0.045, 0.135, -0.148, 0.148, 2.4},
          {1.040, -0.030, 0.138, -0.133, 0.133, 2.4}, {1.080, -0.023, 0.140, -0.121, 0.121, 2.5},
          {1.120, -0.024, 0.144, -0.121, 0.121, 2.6}, {1.160, -0.028, 0.148, -0.126, 0.126, 2.7},
          {1.200, -0.039, 0.148, -0.134, 0.134, 2.7}, {1.240, -0.051, 0.144, -0.142, 0.142, 2.7},
          {1.280, -0.060, 0.134, -0.149, 0.149, 2.6}, {1.320, -0.063, 0.117, -0.153, 0.153, 2.6},
          {1.355, -0.060, 0.100, -0.157, 0.157, 2.6}, {1.385, -0.053, 0.083, -0.146, 0.146, 2.5},
          {1.410, -0.042, 0.070, -0.117, 0.117, 2.3}, {1.430, -0.035, 0.065, -0.082, 0.082, 2.1},
          {1.450, -0.027, 0.068, -0.058, 0.058, 2.0}, {1.470, -0.019, 0.075, -0.051, 0.051, 2.0},
          {1.500, -0.010, 0.084, -0.048, 0.048, 2.0}, {1.550, 0.000, 0.100, -0.048, 0.048, 2.0}};
}

std::vector<Section> leg_sections() {
  return {{0.030, -0.004, 0.074, 0.078, 0.130, 2.0}, {0.080, -0.008, 0.066, 0.080, 0.129, 2.1},
          {0.120, -0.008, 0.056, 0.081, 0.131, 2.1}, {0.170, -0.013, 0.055, 0.082, 0.139, 2.1},
          {0.230, -0.023, 0.061, 0.077, 0.150, 2.0}, {0.290, -0.033, 0.068, 0.068, 0.160, 2.0},
          {0.350, -0.037, 0.075, 0.061, 0.168, 2.0}, {0.410, -0.032, 0.080, 0.060, 0.168, 2.0},
          {0.470, -0.013, 0.095, 0.053, 0.161, 2.0}, {0.530, -0.002, 0.114, 0.045, 0.155, 2.0},
          {0.590, -0.009, 0.125, 0.035, 0.157, 2.0}, {0.650, -0.017, 0.134, 0.026, 0.166, 2.0},
          {0.710, -0.024, 0.139, 0.018, 0.175, 2.1}, {0.770, -0.036, 0.136, 0.013, 0.180, 2.1},
          {0.830, -0.052, 0.126, 0.012, 0.182, 2.2}, {0.880, -0.060, 0.114, 0.014, 0.178, 2.2},
          {0.940, -0.050, 0.100, 0.030, 0.160, 2.2}};
}

// Arm frames: z up along the bone, x forward, origin at its upper joint.
std::vector<Section> upper_arm_sections() {
  return {{-0.290, -0.036, 0.036, -0.035, 0.035}, {-0.250, -0.037, 0.037, -0.036, 0.036},
          {-0.200, -0.040, 0.041, -0.038, 0.038}, {-0.140, -0.043, 0.044, -0.040, 0.040},
          {-0.080, -0.046, 0.047, -0.043, 0.044}, {-0.030, -0.049, 0.050, -0.045, 0.048},
          {0.010, -0.047, 0.048, -0.043, 0.046},  {0.040, -0.040, 0.040, -0.036, 0.036}};
}

std::vector<Section> forearm_sections() {
  return {{-0.250, -0.025, 0.025, -0.018, 0.018}, {-0.210, -0.026, 0.026, -0.021, 0.021},
          {-0.150, -0.031, 0.031, -0.027, 0.027}, {-0.090, -0.037, 0.037, -0.034, 0.034},
          {-0.040, -0.039, 0.038, -0.036, 0.036}, {0.015, -0.034, 0.034, -0.033, 0.033}};
}

double bell(double t) {
  return std::exp(-t * t);
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vector3d mirrored(const Vector3d& p) {
  return {p.x(), -p.y(), p.z()};
}
Vector3d on_left(const Vector3d& p) {
  return {p.x(), std::abs(p.y()), p.z()};
}

}  // namespace

BodyShape::BodyShape(const BodyParameters& parameters)
    : scale_(parameters.stature / kReferenceStature),
      waist_(parameters.waist),
      hip_(parameters.hip),
      torso_(torso_sections(), 0.05),
      leg_(leg_sections(), 0.03),
      upper_arm_(upper_arm_sections(), 0.06),
      forearm_(forearm_sections(), 0.04) {
  for (int side = 0; side < 2; ++side) {
    Breast& breast = breasts_[side];
    breast.size = parameters.bust * (1 + (side == 0 ? 0.5 : -0.5) * parameters.asymmetry);
    breast.sag = 1 - parameters.firmness;
    breast.centre =
        kBreastCentre - Vector3d(0, 0.04 * (breast.size - 1), 0.020 * breast.sag + 0.06 * (breast.size - 1));
    breast.local = Eigen::AngleAxisd(-kBreastOutward, Vector3d::UnitZ()).toRotationMatrix();
    // The mound's tip: as far forward as the reach, as far down as the sag takes it there
    breast.nipple =
        breast.centre + breast.local.transpose() * Vector3d(breast.size * kBreastReach.x(), 0,
                                                            -kBreastSag * breast.sag * breast.size);
  }
  const Eigen::Isometry3d shoulder =
      Eigen::Translation3d(kShoulderJoint) *
      Eigen::Isometry3d(Eigen::AngleAxisd(parameters.arm_angle, Vector3d::UnitX()));
  const Eigen::Isometry3d elbow = shoulder * Eigen::Translation3d(0, 0, -kUpperArm) *
                                  Eigen::AngleAxisd(-kElbowFlexion, Vector3d::UnitY());
  upper_arm_from_body_ = shoulder.inverse();
  forearm_from_body_ = elbow.inverse();
}

double BodyShape::Breast::value(const Vector3d& p) const {
  Vector3d q = local * (p - centre);
  const double forward = std::max(q.x(), 0.0) / (size * kBreastReach.x());
  q.z() += kBreastSag * sag * size * forward * forward;
  Vector3d radii = size * kBreastReach;
  if (q.z() > 0) {
    radii.z() = size * kBreastUp;
    q.x() += kBreastSlope * q.z() * q.z() / (q.z() + 0.03);
  }
  const double bump = (p - nipple).squaredNorm() / (2 * kNippleWidth * kNippleWidth);
  return ellipsoid(q, radii) - (bump < 20 ? kNippleHeight * std::exp(-bump) : 0);
}

double BodyShape::breasts(const Vector3d& p) const {
  return smooth_union(breasts_[0].value(p), breasts_[1].value(mirrored(p)), 0.020);
}

double BodyShape::trunk(const Vector3d& p) const {
  const double hips = 1 + (hip_ - 1) * bell((p.z() - 0.87) / 0.16);
  const double girth = hips * (1 + (waist_ - 1) * bell((p.z() - 1.08) / 0.085));
  const Vector3d q(0.04 + (p.x() - 0.04) / girth, p.y() / girth, p.z());
  const double legs = smooth_union(leg_(q), leg_(mirrored(q)), 0.010);
  const auto buttock = [&q](double side) {
    return ellipsoid(q - Vector3d(-0.018, side * 0.068, 0.885), {0.078, 0.072, 0.085});
  };
  double d = smooth_union(torso_(q), legs, 0.035);
  d = smooth_union(d, smooth_union(buttock(1), buttock(-1), 0.012), 0.040);
  d -= 0.003 * bell((q - Vector3d(-0.035, 0, 1.430)).norm() / 0.014);  // the spine's lowest neck vertebra
  d += 0.006 * bell((q - Vector3d(0.139, 0, 1.050)).norm() / 0.009);   // navel
  d *= girth;
  // A crease under the breast, a gentle slope above it
  const double level = (breasts_[0].centre.z() + breasts_[1].centre.z()) / 2 - 0.02;
  const double k = 0.014 + 0.050 * smooth_step((p.z() - level) / 0.10);
  return smooth_union(d, breasts(p), k);
}

double BodyShape::arm(const Vector3d& p) const {
  const Vector3d upper = upper_arm_from_body_ * p, fore = forearm_from_body_ * p;
  const double palm = ellipsoid(fore - Vector3d(0.004, 0, -0.290), {0.040, 0.017, 0.058});
  const double fingers = ellipsoid(fore - Vector3d(0.000, -0.006, -0.365), {0.034, 0.012, 0.062});
  const double thumb = tapered_capsule(fore, {0.020, -0.004, -0.270}, {0.062, -0.014, -0.335}, 0.014, 0.009);
  double d = smooth_union(upper_arm_(upper), forearm_(fore), 0.030);
  d = smooth_union(d, palm, 0.025);
  d = smooth_union(d, fingers, 0.015);
  return smooth_union(d, thumb, 0.012);
}

double BodyShape::head(const Vector3d& p) const {
  const double cranium = ellipsoid(p - Vector3d(0.052, 0, 1.603), {0.098, 0.076, 0.097});
  const double face = ellipsoid(p - Vector3d(0.086, 0, 1.555), {0.060, 0.058, 0.079});
  const double nose = tapered_capsule(p, {0.142, 0, 1.585}, {0.156, 0, 1.550}, 0.006, 0.010);
  return smooth_union(smooth_union(cranium, face, 0.030), nose, 0.012);
}

double BodyShape::reference_value(const Vector3d& p) const {
  const Vector3d left = on_left(p);
  double d = trunk(p);
  d = smooth_union(d, arm(left),
                   0.024 + 0.036 * smooth_step((p.z() - 1.27) / 0.08));  // sharper in the armpit
  d = smooth_union(d, head(p), 0.030);
  const double heel = ellipsoid(left - Vector3d(0.021, 0.104, 0.031), {0.040, 0.034, 0.046});
  const double sole = ellipsoid(left - Vector3d(0.095, 0.110, 0.018), {0.098, 0.043, 0.028});
  const double instep = tapered_capsule(left, {0.035, 0.104, 0.085}, {0.120, 0.108, 0.020}, 0.034, 0.020);
  const double foot = smooth_union(smooth_union(heel, sole, 0.03), instep, 0.03);
  // Soles round off at their edges; the plane lies lower by what the rounding takes from the heels
  return smooth_intersection(smooth_union(d, foot, 0.02), -0.0006 - p.z(), 0.030);
}

double BodyShape::value(const Vector3d& p) const {
  return scale_ * reference_value(p / scale_);
}

Eigen::AlignedBox3d BodyShape::half_box() const {
  // Room for arms held out
  return {Vector3d(scaled(-0.18), 0, 0), Vector3d(scaled(0.42), scaled(0.75), scaled(1.74))};
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
  return arm(on_left(q)) < trunk(q);
}

BodyShape::Axis BodyShape::breast_axis(bool left) const {
  const Breast& breast = breasts_[left ? 0 : 1];
  const Vector3d forward = breast.local.row(0),
                 origin = breast.nipple - 0.5 * breast.size * kBreastReach.x() * forward;
  if (left) return {scale_ * origin, forward};
  return {scale_ * mirrored(origin), mirrored(forward)};
}

BodyShape::Axis BodyShape::upper_arm_axis(bool left) const {
  const Eigen::Isometry3d body_from_arm = upper_arm_from_body_.inverse();
  const Vector3d origin = scale_ * body_from_arm.translation(), down = -(body_from_arm.linear().col(2));
  return left ? Axis{origin, down} : Axis{mirrored(origin), mirrored(down)};
}

BodyShape::Axis BodyShape::neck_axis() const {
  return {scale_ * Vector3d(0.033, 0, 1.471), Vector3d(0.373, 0, 0.928).normalized()};
}

}  // namespace tensegric_fit::booth
