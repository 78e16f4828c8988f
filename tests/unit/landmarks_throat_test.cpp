// Where chin and neck meet, on a chin and a throat that are joined by an arc.
#include <gtest/gtest.h>

#include <cmath>

#include "landmarks/throat.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kThroat = 0.05, kChin = 1.50, kArc = 0.020;  // m: x, z, radius
constexpr double kDeepest = 1.41;                             // m: z where the throat turns to the chest

constexpr double kSagsFrom = 80 * kDegree;

// The throat's x: straight down, back for 20 mm, and out to the chest.
double throat_at(double z) {
  if (z > kDeepest + 0.020) return kThroat;
  if (z > kDeepest) return kThroat - 0.36 * (kDeepest + 0.020 - z);
  return kThroat - 0.36 * 0.020 + 0.84 * (kDeepest - z);
}

// A level chin over a throat. `sag`: from where it has turned by 10 degrees, skin runs on into the chin, so
// far, before it turns, as a surface does that is drawn over what no sensor saw from below.
double chin_and_throat(const Vector3d& p, double sag) {
  const double before_throat = p.x() - throat_at(p.z()), below_chin = kChin - p.z();
  double d = std::min(before_throat, below_chin);
  if (before_throat < kArc && below_chin < kArc)
    d = kArc - std::hypot(kArc - before_throat, kArc - below_chin);
  if (sag <= 0) return d;
  const double tight = kArc / 2;
  const Vector3d arc(kThroat + kArc, p.y(), kChin - kArc), up(std::sin(kSagsFrom), 0, std::cos(kSagsFrom)),
      out(up.z(), 0, -up.x());
  return std::max(d, -test::capsule(p, arc, arc + sag * up - (kArc - tight) * out, kArc, tight));
}

landmarks::ThroatProfile throat_of(const test::Distance& distance) {
  static const geometry::TriangleMesh person = test::person_mesh();
  landmarks::BodyShape body(person);  // lends its stature
  body.mesh = test::surface_of(distance, {-0.02, -0.03, 1.33}, {0.16, 0.03, 1.53}, 0.0031);
  return landmarks::find_throat(body, {{0, 0, kChin}, landmarks::kUprightLean});
}

landmarks::ThroatProfile throat_under_chin(double sag) {
  return throat_of([sag](const Vector3d& p) { return chin_and_throat(p, sag); });
}

const Vector3d& corner_of(const landmarks::ThroatProfile& throat) {
  return throat.profile.points.at(throat.corner);
}

TEST(Throat, TheCornerIsWhereSkinBeginsToTurnIntoTheNeck) {
  const landmarks::ThroatProfile throat = throat_under_chin(0);
  ASSERT_GE(throat.corner, 0);
  // Three tenths of the way from a level chin into the neck's direction.
  const double turned = 0.7 * 90 * kDegree + 0.3 * landmarks::kUprightLean;
  const Vector3d expected(kThroat + kArc * (1 - std::cos(turned)), 0, kChin - kArc * (1 - std::sin(turned)));
  // A profile has steps of 1 mm and is smoothed over 3 mm.
  EXPECT_NEAR((corner_of(throat) - expected).norm(), 0, 0.002) << corner_of(throat).transpose();
  ASSERT_GE(throat.deepest, 0);
  EXPECT_NEAR(throat.profile.points[throat.deepest].z(), kDeepest, 0.002);
}

TEST(Throat, AFillingThatSagsIntoTheChinHardlyMovesTheCorner) {
  const Vector3d sound = corner_of(throat_under_chin(0));
  const landmarks::ThroatProfile throat = throat_under_chin(0.016);
  ASSERT_GE(throat.corner, 0);
  int sharpest = throat.corner;
  for (int i = 0; i < throat.corner; ++i)
    if (throat.profile.hollowness(i, 8) > throat.profile.hollowness(sharpest, 8)) sharpest = i;
  // The filling is most hollow where it joins the chin, 20 mm further forwards.
  EXPECT_GT(throat.profile.points[sharpest].x(), sound.x() + 0.015);
  // The filling turns the chin's direction a little: that much is left.
  EXPECT_NEAR((corner_of(throat) - sound).norm(), 0, 0.003) << corner_of(throat).transpose();
}

TEST(Throat, WithoutAChinThereIsNoCorner) {
  const landmarks::ThroatProfile throat =
      throat_of([](const Vector3d& p) { return p.x() - throat_at(p.z()); });
  EXPECT_EQ(throat.corner, -1);
  ASSERT_GE(throat.deepest, 0);
  EXPECT_NEAR(throat.profile.points[throat.deepest].z(), kDeepest, 0.002);
}

}  // namespace
}  // namespace tensegric_fit
