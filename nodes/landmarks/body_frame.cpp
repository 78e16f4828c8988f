#include "landmarks/body_frame.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "landmarks/body_levels.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::TriangleMesh;

constexpr double kDegree = 3.14159265358979323846 / 180;
// Bare soles bear a person on a hand's breadth, so their plane is good to a degree or two. A booth's own
// vertical is better wherever the two agree that far.
constexpr double kTiltOfSoles = 2.5 * kDegree;
// The line of gravity falls some 35 mm behind the middle of the skin of feet and ankles: so much a metre of
// the centre's height.
constexpr double kBehindFeet = 0.038;
// Swaying, stooping and uneven weight leave balance uncertain by this much; soles that say more were not
// seen.
constexpr double kTiltOfBalance = 3 * kDegree;
// Soles that were closed with the plane of a floor are flat within half a millimetre for 80 % of their skin;
// bare ones, of any shape, for less than 30 %.
constexpr double kSole = 0.005, kOnPlane = 0.0005, kFlatShare = 0.5;
constexpr double kMostTilt = 25 * kDegree;  // DESIGN §2 promises 15

// Centre of the volume, as if the body were of one density.
Vector3d centre_of_volume(const TriangleMesh& mesh) {
  const Vector3d origin = mesh.vertices.front();
  Vector3d moment = Vector3d::Zero();
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin,
                   c = mesh.vertices[t[2]] - origin;
    const double v = a.dot(b.cross(c));
    volume += v;
    moment += v * (a + b + c) / 4;
  }
  if (volume <= 0)
    throw geometry::Refusal(geometry::refusal::kNotABody, "the mesh encloses no volume, or is inside out");
  return origin + moment / volume;
}

double lowest_along(const TriangleMesh& mesh, const Vector3d& up) {
  double lowest = up.dot(mesh.vertices.front());
  for (const Vector3d& v : mesh.vertices) lowest = std::min(lowest, up.dot(v));
  return lowest;
}

double extent_along(const TriangleMesh& mesh, const Vector3d& up) {
  return -lowest_along(mesh, -up) - lowest_along(mesh, up);
}

// A standing person's centre of mass is above the feet.
Vector3d up_from_balance(const TriangleMesh& mesh) {
  const Vector3d centre = centre_of_volume(mesh);
  Vector3d up = Vector3d::UnitZ();
  for (int pass = 0; pass < 6; ++pass) {
    // Feet and ankles: at 15 degrees of tilt one foot is still 0.04 statures above the other.
    const double limit = lowest_along(mesh, up) + 0.08 * extent_along(mesh, up);
    Vector3d feet = Vector3d::Zero();
    double weight = 0;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      if (up.dot(a + b + c) / 3 > limit) continue;
      const double area = geometry::area_vector(a, b, c).norm();
      feet += area * (a + b + c) / 3;
      weight += area;
    }
    const Vector3d axis = centre - feet / std::max(weight, 1e-12);
    if (weight <= 0 || axis.norm() < 1e-6) return Vector3d::UnitZ();
    up = axis.normalized();
  }
  return up;
}

// The plane up . x = offset that skin facing down lies on.
struct SolePlane {
  Vector3d up;
  double offset;
};

// Fits the plane anew to skin that faces down; farther than `scale` metres from it, skin loses its say. False
// where the soles tell nothing.
bool refit(const TriangleMesh& mesh, double scale, double stature, SolePlane& plane) {
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double weight = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector3d middle = (a + b + c) / 3, area = geometry::area_vector(a, b, c);
    const double off = (plane.up.dot(middle) - plane.offset) / scale;
    if (std::abs(off) > 3 || plane.up.dot(area) > -0.8 * area.norm()) continue;
    const double w = area.norm() * std::exp(-0.5 * off * off);
    sum += w * middle;
    squares += w * middle * middle.transpose();
    weight += w;
  }
  if (weight <= 0) return false;
  const Vector3d mean = sum / weight;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / weight - mean * mean.transpose());
  // Two feet spread in both directions by 0.03 statures or more; anything less says little about a plane.
  if (axes.eigenvalues()[1] < std::pow(0.015 * stature, 2)) return false;
  const Vector3d normal = axes.eigenvectors().col(0);
  plane.up = normal.dot(plane.up) < 0 ? Vector3d(-normal) : normal;
  plane.offset = plane.up.dot(mean);
  return true;
}

// Share of the soles' skin that lies on the plane itself.
double flat_share(const TriangleMesh& mesh, const SolePlane& plane) {
  double on_plane = 0, all = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector3d area = geometry::area_vector(a, b, c);
    const double off = std::abs(plane.up.dot(a + b + c) / 3 - plane.offset);
    if (off > kSole || plane.up.dot(area) > -0.8 * area.norm()) continue;
    all += area.norm();
    if (off < kOnPlane) on_plane += area.norm();
  }
  return all > 0 ? on_plane / all : 0;
}

struct Soles {
  Vector3d up;
  bool flat;  // and so exact
};

// Normal of the plane that both soles rest on: what is above the plane loses its say.
Soles up_from_soles(const TriangleMesh& mesh, const Vector3d& roughly_up) {
  const Soles none{roughly_up, false};
  SolePlane plane{roughly_up, lowest_along(mesh, roughly_up)};
  const double stature = extent_along(mesh, roughly_up);
  for (double scale :
       {0.012, 0.008, 0.005, 0.004, 0.003, 0.003, 0.003, 0.003}) {  // of stature: 20 mm down to 5 mm
    if (!refit(mesh, scale * stature, stature, plane) || plane.up.dot(roughly_up) < std::cos(12 * kDegree))
      return none;
    plane.offset = lowest_along(mesh, plane.up);
  }
  SolePlane fine = plane;
  for (double scale : {0.003, 0.002, 0.0015, 0.001, 0.0007, 0.0005, 0.0005})
    if (!refit(mesh, scale, stature, fine)) return {plane.up, false};
  if (flat_share(mesh, fine) > kFlatShare) return {fine.up, true};
  return {plane.up, false};
}

TriangleMesh moved(const TriangleMesh& mesh, const Eigen::Isometry3d& motion) {
  TriangleMesh result = mesh;
  for (Vector3d& v : result.vertices) v = motion * v;
  return result;
}

// The direction in which trunk and pair of legs are widest.
Vector2d widest_direction(const BodyLevels& body) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  const double lowest = 0.25 * body.stature, highest = 0.70 * body.stature,
               bottom = body.levels.front().height;
  for (const Level& level : body.levels) {
    if (level.height - bottom < lowest || level.height - bottom > highest) continue;
    if (level.trunk >= 0) {
      const Outline& trunk = level.outlines[level.trunk];
      moment += second_moment(trunk, trunk.centroid);
    } else if (level.legs[0] >= 0 && level.legs[1] >= 0) {
      const Outline &a = level.outlines[level.legs[0]], &b = level.outlines[level.legs[1]];
      const Vector2d middle = (a.centroid + b.centroid) / 2;
      moment += second_moment(a, middle) + second_moment(b, middle);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvectors().col(1);
}

// Mean centroid of the two legs at a share of stature; false where one is not there.
bool middle_of_legs(const BodyLevels& body, double share, Vector2d& middle) {
  const Level& level = body.levels[body.nearest(body.levels.front().height + share * body.stature)];
  if (level.legs[0] < 0 || level.legs[1] < 0) return false;
  middle = (level.outlines[level.legs[0]].centroid + level.outlines[level.legs[1]].centroid) / 2;
  return true;
}

// How far the feet reach in front of the ankles, along `forward`, as a share of stature: some 0.03.
double reach_of_feet(const BodyLevels& body, const Vector2d& forward) {
  Vector2d ankles, feet;
  if (!middle_of_legs(body, 0.06, ankles) || !middle_of_legs(body, 0.015, feet)) return 0;
  return forward.dot(feet - ankles) / body.stature;
}

// How much further the chest reaches forward than back, compared with the seat, as a share of stature: some
// 0.05.
double reach_of_chest(const BodyLevels& body, const Vector2d& forward) {
  const auto middle = [&](double share) {
    const Level& level = body.levels[body.nearest(body.levels.front().height + share * body.stature)];
    if (level.trunk < 0) return 0.0;
    double low = 1e9, high = -1e9;
    for (const Vector3d& p : level.outlines[level.trunk].points) {
      low = std::min(low, forward.dot(p.head<2>()));
      high = std::max(high, forward.dot(p.head<2>()));
    }
    return (low + high) / 2;
  };
  return (middle(0.71) - middle(0.51)) / body.stature;
}

struct Front {
  Vector2d forward;
  double confidence;
  std::string reason;
};

// Of the two ways across the widest direction, the one that the feet point; the chest confirms.
Front find_front(const BodyLevels& levels) {
  const Vector2d left = widest_direction(levels);
  Front front{{left.y(), -left.x()}, 0.4, ""};
  const double feet = reach_of_feet(levels, front.forward), chest = reach_of_chest(levels, front.forward);
  const bool feet_tell = std::abs(feet) > 0.008;
  if ((feet_tell ? feet : chest) < 0) front.forward = -front.forward;
  if (feet_tell) {
    front.confidence = feet * chest > 0 ? 0.95 : 0.6;
  } else {
    front.reason = "the feet do not tell front from back; judged by the chest alone";
  }
  return front;
}

Eigen::Isometry3d upright_for(const Vector3d& up) {
  Eigen::Isometry3d upright = Eigen::Isometry3d::Identity();
  upright.linear() = Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix();
  return upright;
}

// The levels of a body that stands; one on its head is refused as such.
BodyLevels standing_levels(const TriangleMesh& mesh, const Eigen::Isometry3d& upright) {
  try {
    return find_levels(SlicedMesh(moved(mesh, upright)));
  } catch (const geometry::Refusal& refused) {
    if (refused.code() == geometry::refusal::kWrongUnit) throw;
    const Eigen::Isometry3d turned = Eigen::AngleAxisd(180 * kDegree, Vector3d::UnitX()) * upright;
    try {
      find_levels(SlicedMesh(moved(mesh, turned)));
    } catch (const geometry::Refusal&) {
      throw refused;
    }
    throw geometry::Refusal(geometry::refusal::kNotABody, "not a standing body: it is upside down");
  }
}

}  // namespace

BodyFrame find_body_frame(const TriangleMesh& body) {
  // 1. Up from balance, good to a few degrees: enough to see which way the feet point.
  const Vector3d balanced = up_from_balance(body);
  if (balanced.z() < std::cos(kMostTilt))
    throw geometry::Refusal(geometry::refusal::kNotABody,
                            "not a standing body: its weight is not above its feet");
  const Eigen::Isometry3d roughly = upright_for(balanced);
  const Front rough_front = find_front(standing_levels(body, roughly));

  // 2. Up from the soles, where they agree with balance; the scan's own vertical, where it agrees with that
  // and the soles do not know better.
  const Vector3d forward =
      roughly.linear().transpose() * Vector3d(rough_front.forward.x(), rough_front.forward.y(), 0);
  const Vector3d corrected = (balanced + kBehindFeet * forward).normalized();
  const Soles soles = up_from_soles(body, corrected);
  const bool believed = soles.flat || soles.up.dot(corrected) > std::cos(kTiltOfBalance);
  Vector3d up = believed ? soles.up : corrected;
  if (!soles.flat && up.z() > std::cos(kTiltOfSoles)) up = Vector3d::UnitZ();
  const Eigen::Isometry3d upright = upright_for(up);

  // 3. Front and origin in that posture.
  const BodyLevels levels = find_levels(SlicedMesh(moved(body, upright)));
  const Front front = find_front(levels);
  Vector2d origin = levels.parted().outlines.front().centroid;
  middle_of_legs(levels, 0.015, origin);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  const double yaw = std::atan2(front.forward.y(), front.forward.x());
  turned.linear() = Eigen::AngleAxisd(-yaw, Vector3d::UnitZ()).toRotationMatrix();
  const double floor = levels.levels.front().height - levels.step / 2;
  return {turned * Eigen::Translation3d(-origin.x(), -origin.y(), -floor) * upright, front.confidence,
          front.reason};
}

}  // namespace tensegric_fit::landmarks
