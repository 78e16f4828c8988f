// Which way is up: the scan's vertical, or what legs and soles stand on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "body_model/registration.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

/// The mean woman in a scan that is tilted sideways by so much, radians.
RegisteredBody tilted(double angle) {
  RegisteredBody body;
  body.model = shipped_registrar().shared_model();
  body.parameters = Parameters(*body.model);
  const PosedModel posed(*body.model, body.parameters);
  body.posed = body.skin = posed.vertices();
  for (std::size_t bone = 0; bone < body.model->bones.size(); ++bone)
    body.joints.push_back(posed.joint(static_cast<int>(bone)));
  body.vertical = Eigen::AngleAxisd(angle, Vector3d::UnitY()) * body.vertical;
  return body;
}

double off(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(Standing, KeepsTheVerticalOfALevelScan) {
  const RegisteredBody body = tilted(0);
  EXPECT_LT(off(upright(body, shipped_registrar().standing()), body.vertical), 1e-9);
}

TEST(Standing, StraightensATiltedScan) {
  for (const double degrees : {-15.0, -6.0, 6.0, 15.0}) {
    const Vector3d up = upright(tilted(degrees * M_PI / 180), shipped_registrar().standing());
    EXPECT_LT(off(up, Vector3d::UnitZ()) * 180 / M_PI, 1.5) << degrees;
  }
}

// A tilt by a hair more turns `up` by little more: between upright and leaning there is no step.
TEST(Standing, HasNoStep) {
  const double step = 1e-4;
  Vector3d before = upright(tilted(0), shipped_registrar().standing());
  double steepest = 0, farthest = 0;
  for (double angle = step; angle < 0.1; angle += step) {
    const RegisteredBody body = tilted(angle);
    const Vector3d up = upright(body, shipped_registrar().standing());
    steepest = std::max(steepest, off(up, before) / step);
    farthest = std::max(farthest, off(up, body.vertical));
    before = up;
  }
  EXPECT_GT(farthest, 0.05);  // it was passed
  EXPECT_LT(steepest, 4);     // 1 + 3 deviations / 1 of blending; a step would be hundreds
}

}  // namespace
}  // namespace tensegric_fit::body_model
