#include "virtual_body/body_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/status.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;

// The most concave point of the sagittal profile below a bust point, and its curvature, 1/m.
struct ProfileFold {
  Vector3d point;
  double curvature;
};

// Where a level ray from the front meets the skin first.
Vector3d foremost(const BodyShape& shape, double y, double z) {
  Vector3d p(shape.scaled(0.60), y, z);
  while (p.x() > 0 && shape.value(p) > 0) p.x() -= 0.002;
  return shape.exit_point(p, Vector3d::UnitX());
}

ProfileFold fold_below(const BodyShape& shape, double y, double bust_height) {
  const double step = shape.scaled(0.001);
  constexpr int kSteps = 320, kWindow = 4;  // curvature over 8 mm, less than a fold's width
  constexpr double kAbove = 0.03;           // where a breast hangs, its fold is higher than its tip
  const Vector3d in_plane(1, 0, 1);
  Vector3d p = foremost(shape, y, bust_height + shape.scaled(kAbove));
  std::vector<Vector3d> profile;
  std::vector<double> turn;  // direction of the outward normal, upwards positive
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d g = shape.gradient(p).cwiseProduct(in_plane).normalized();
    profile.push_back(p);
    turn.push_back(std::atan2(g.z(), g.x()));
    p = shape.project(p + step * Vector3d(g.z(), 0, -g.x()), in_plane);
  }
  ProfileFold fold{profile.front(), 0};
  for (int i = kWindow; i + kWindow < kSteps; ++i) {
    const double curvature = (turn[i + kWindow] - turn[i - kWindow]) / (2 * kWindow * step);
    if (curvature > fold.curvature && shape.is_under_breast(profile[i])) fold = {profile[i], curvature};
  }
  return fold;
}

constexpr double kFlat = 20;  // 1/m: a profile that is less concave has no fold

ProfileFold fold_under(const BodyShape& shape, const Vector3d& bust_point) {
  const ProfileFold fold = fold_below(shape, bust_point.y(), bust_point.z());
  if (fold.curvature > kFlat) return fold;
  throw geometry::Refusal(
      geometry::refusal::kBadOption,
      "with these body parameters a breast hangs beside the trunk, without a fold under it; "
      "lower 'bust' or raise 'waist'");
}

// From the fold under the bust point to 55 mm towards the middle.
Vector3d lowest_fold(const BodyShape& shape, const Vector3d& bust_point) {
  constexpr double kReach = 0.055, kStep = 0.005;
  Vector3d lowest = fold_under(shape, bust_point).point;
  for (double medial = kStep; medial < kReach + kStep / 2; medial += kStep) {
    const double y = bust_point.y() - std::copysign(medial, bust_point.y());
    const ProfileFold fold = fold_below(shape, y, bust_point.z());
    if (fold.curvature > kFlat && fold.point.z() < lowest.z()) lowest = fold.point;
  }
  return lowest;
}

// The point of the left or right buttock that is farthest back.
Vector3d rearmost(const BodyShape& shape, double side) {
  const auto skin = [&shape](double y, double z) { return shape.exit_point({0, y, z}, -Vector3d::UnitX()); };
  double y = side * shape.scaled(0.065), z = shape.scaled(0.89);
  Vector3d best = skin(y, z);
  for (double step = shape.scaled(0.01); step > 1e-5; step /= 2) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [dy, dz] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
        const Vector3d p = skin(y + dy, z + dz);
        if (p.x() < best.x() - 1e-9) {
          best = p;
          y += dy;
          z += dz;
          moved = true;
        }
      }
    }
  }
  return best;
}

// The notch at the throat: where the front of the neck is farthest back on a body without a stoop.
Vector3d throat(const BodyShape& shape) {
  Vector3d deepest;
  double ahead = std::numeric_limits<double>::infinity();
  for (double z = 1.390; z < 1.460; z += 0.0005) {
    const Vector3d inside(0.02, 0, z);
    const Vector3d p =
        shape.exit_point(shape.posed(inside), shape.posed_direction(inside, Vector3d::UnitX()));
    if (shape.upright(p).x() >= ahead) continue;
    ahead = shape.upright(p).x();
    deepest = p;
  }
  return deepest;
}

// At this height, the way from front to back between trunk and arm that stays farthest out of the body; by
// how much.
struct Passage {
  Vector3d narrowest;
  double clearance;
};

Passage passage(const BodyShape& shape, double side, double z) {
  const Ray arm = shape.upper_arm_axis(side > 0);
  const Vector3d bone = arm.origin + (z - arm.origin.z()) / arm.direction.z() * arm.direction;
  Passage result{Vector3d::Zero(), std::numeric_limits<double>::infinity()};
  for (double x = -0.058; x < 0.062; x += 0.002) {
    Passage here{Vector3d::Zero(), -1};
    for (double y = shape.scaled(0.10); y < std::abs(bone.y()); y += 0.001) {
      const Vector3d p(arm.origin.x() + shape.scaled(x), side * y, z);
      const double v = shape.value(p);
      if (v > here.clearance) here = {p, v};
    }
    if (here.clearance < result.clearance) result = here;
  }
  return result;
}

Vector3d axilla(const BodyShape& shape, double side) {
  const double joint = shape.upper_arm_axis(side > 0).origin.z();
  double open = joint - shape.scaled(0.18), closed = joint + shape.scaled(0.02);
  while (closed - open > 0.0002) {
    const double middle = (open + closed) / 2;
    (passage(shape, side, middle).clearance > 0 ? open : closed) = middle;
  }
  return shape.project(passage(shape, side, open).narrowest);
}

// Along the midline of the perineum, both ways from its middle.
Vector3d lowest_of_midline(const BodyShape& shape) {
  constexpr double kStep = 0.0005, kReach = 0.060;  // m
  const Vector3d in_plane(1, 0, 1);
  const Vector3d middle = shape.exit_point(shape.posed_bone({0.014, 0, 0.90}), -Vector3d::UnitZ());
  Vector3d lowest = middle;
  for (const double way : {kStep, -kStep}) {
    Vector3d p = middle;
    while ((p - middle).norm() < kReach) {
      const Vector3d g = shape.gradient(p).cwiseProduct(in_plane).normalized();
      p = shape.project(p + way * Vector3d(g.z(), 0, -g.x()), in_plane);
      if (p.z() < lowest.z()) lowest = p;
    }
  }
  return lowest;
}

}  // namespace

std::vector<geometry::Landmark> find_body_landmarks(const BodyShape& shape) {
  std::vector<geometry::Landmark> landmarks;
  const auto add = [&landmarks](const std::string& name, const Vector3d& p) {
    landmarks.push_back({name, p, 1.0, ""});
  };
  // From a point of the reference body outwards
  const auto skin = [&shape](const Vector3d& inside, const Vector3d& direction) {
    return shape.exit_point(shape.posed(inside), shape.posed_direction(inside, direction));
  };
  // From a bone, which is where it was however thick she is: fat lifts the skin up the slope of nape and neck
  const auto over_bone = [&shape](const Vector3d& bone, const Vector3d& direction) {
    return shape.exit_point(shape.posed_bone(bone), shape.posed_direction(bone, direction));
  };
  for (const bool left : {true, false}) {
    const double side = left ? 1 : -1;
    const std::string suffix = left ? "_L" : "_R";
    const Ray breast = shape.breast_axis(left);
    const Vector3d bust_point = shape.exit_point(breast.origin, breast.direction);
    add("bust_point" + suffix, bust_point);
    add("underbust" + suffix, fold_under(shape, bust_point).point);
    add("fold_lowest" + suffix, lowest_fold(shape, bust_point));
    add("shoulder" + suffix, shape.exit_point(shape.acromion(left), Vector3d::UnitZ()));
    add("neck_side" + suffix, over_bone({0.0514, 0.007 * side, 1.422}, Vector3d(-0.39, 0.85 * side, 0.35)));
    add("axilla" + suffix, axilla(shape, side));
    add("buttock" + suffix, rearmost(shape, side));
  }
  add("neck_front", throat(shape));
  add("neck_back", over_bone({-0.015, 0, 1.4125}, Vector3d(-0.94, 0, 0.342)));
  add("navel", skin({0.05, 0, 1.050}, Vector3d::UnitX()));
  add("crotch", lowest_of_midline(shape));
  return landmarks;
}

}  // namespace tensegric_fit::virtual_body
