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
  body.off.assign(body.skin.size(), 0);
  body.support = body.off;  // all of her is there
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

/// As if no sample were there.
void take_away(RegisteredBody& body, const std::vector<std::string>& parts) {
  for (std::size_t v = 0; v < body.skin.size(); ++v)
    if (std::count(parts.begin(), parts.end(), body.model->parts[body.model->part[v]]) > 0)
      body.support[v] = body.off[v] = 1;
}

// What the model has for legs that were not seen may stand anyhow.
TEST(Standing, LegsThatAreNotThereShowNothing) {
  const std::vector<std::vector<std::string>> lacking = {
      {"thigh_L", "shank_L", "foot_L"},
      {"shank_R", "foot_R"},
      {"thigh_L", "shank_L", "foot_L", "thigh_R", "shank_R", "foot_R"}};
  for (const auto& parts : lacking) {
    RegisteredBody body = tilted(6 * M_PI / 180);
    take_away(body, parts);
    EXPECT_LT(off(upright(body, shipped_registrar().standing()), body.vertical), 1e-9) << parts.front();
  }
  RegisteredBody body = tilted(6 * M_PI / 180);
  take_away(body, {"foot_L"});
  EXPECT_LT(off(upright(body, shipped_registrar().standing()), Vector3d::UnitZ()) * 180 / M_PI, 1.5);
}

TEST(Standing, TheGroundIsLessSureWithoutFeetAndLessStillWithoutLegs) {
  const Standing& standing = shipped_registrar().standing();
  RegisteredBody body = tilted(0);
  double before = standing.ground;
  for (const auto& parts :
       {std::vector<std::string>{"foot_L", "foot_R"}, {"shank_L", "shank_R", "thigh_L", "thigh_R"}}) {
    take_away(body, parts);
    const Ground ground = ground_by_soles(body, standing);
    EXPECT_GT(ground.deviation, before) << parts.front();
    before = ground.deviation;
  }
}

TEST(Standing, AFootThatIsNotThereDoesNotSayWhereTheGroundIs) {
  const Standing& standing = shipped_registrar().standing();
  RegisteredBody body = tilted(0);
  const double ground = ground_by_soles(body, standing).height;
  for (std::size_t v = 0; v < body.posed.size(); ++v)
    if (body.model->parts[body.model->part[v]] == "foot_L") body.posed[v].z() -= 0.05;
  EXPECT_NEAR(ground_by_soles(body, standing).height, ground - 0.05, 0.002);  // the lower one bears her
  take_away(body, {"foot_L"});
  EXPECT_NEAR(ground_by_soles(body, standing).height, ground, 0.002);
}

TEST(Standing, WhereTheLowestOfTheFeetWasNotSeenTheGroundIsUnsure) {
  const Standing& standing = shipped_registrar().standing();
  const RegisteredBody body = tilted(0);
  const double ground = ground_by_soles(body, standing).height;
  const Ground near = settled_ground(body, ground + 0.003, 0, standing);
  EXPECT_EQ(near.height, ground + 0.003);
  EXPECT_EQ(near.deviation, 0);
  const Ground far = settled_ground(body, ground + 0.03, 0, standing);
  EXPECT_NEAR(far.height, ground + 0.015, 1e-9);
  EXPECT_NEAR(far.deviation, 0.015, 1e-9);
}

// However much of the soles is cut off: 0.1 mm more moves the ground by little more, and its deviation.
TEST(Standing, NoCutOfTheFeetMakesTheGroundJump) {
  const Standing& standing = shipped_registrar().standing();
  const RegisteredBody body = tilted(0);
  const double soles = ground_by_soles(body, standing).height;
  Ground before = settled_ground(body, soles, 0, standing);
  for (double cut = 1e-4; cut < 0.03; cut += 1e-4) {
    const Ground ground = settled_ground(body, soles + cut, 0, standing);
    EXPECT_LT(std::abs(ground.height - before.height), 5e-4) << cut;
    EXPECT_GE(ground.deviation, before.deviation) << cut;
    EXPECT_LT(ground.deviation, before.deviation + 3e-4) << cut;
    before = ground;
  }
}

// A raised foot, as with a bent knee, is no tilt of the booth: she stands on the other one.
TEST(Standing, ABentKneeTurnsNothing) {
  const Standing& standing = shipped_registrar().standing();
  const RegisteredBody upright_body = tilted(0);
  const double ground = ground_by_soles(upright_body, standing).height;
  for (const double raised : {0.02, 0.035, 0.1}) {
    RegisteredBody body = upright_body;
    for (std::size_t v = 0; v < body.posed.size(); ++v)
      if (body.model->parts[body.model->part[v]] == "foot_R") body.posed[v].z() += raised;
    EXPECT_LT(off(upright(body, standing), Vector3d::UnitZ()) * 180 / M_PI, 0.01) << raised;
    EXPECT_NEAR(ground_by_soles(body, standing).height, ground, 0.002) << raised;
  }
}

TEST(Standing, StraightensATiltedScan) {
  for (const double degrees : {-15.0, -6.0, 6.0, 15.0}) {
    const Vector3d up = upright(tilted(degrees * M_PI / 180), shipped_registrar().standing());
    EXPECT_LT(off(up, Vector3d::UnitZ()) * 180 / M_PI, 1.5) << degrees;
  }
}

TEST(Standing, AFootFarAheadDoesNotTurnHerFront) {
  const Standing& standing = shipped_registrar().standing();
  const auto turned = [&](double ahead) {  // rad, by a foot that is so many m ahead
    RegisteredBody body = tilted(0);
    const Vector3d square = across(body, standing);
    for (std::size_t bone = 0; bone < body.model->bones.size(); ++bone)
      if (body.model->bones[bone].name == "foot.L") body.joints[bone] += ahead * square.cross(body.vertical);
    return off(across(body, standing), square) * 180 / M_PI;
  };
  EXPECT_GT(turned(0.002), 0.05) << "as a woman's feet are: they count";
  EXPECT_LT(turned(0.06), 1e-6);
  EXPECT_LT(turned(0.20), 1e-6);
  for (double ahead = 0; ahead < 0.06; ahead += 0.0005)  // and there is no step
    EXPECT_NEAR(turned(ahead + 0.0005), turned(ahead), 0.3) << ahead;
}

// A tilt by a hair more turns `up` by little more: between upright and leaning there is no step.
TEST(Standing, HasNoStep) {
  const double step = 4e-4;
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
  EXPECT_LT(steepest, 4);     // 1 + 3 deviations / 1 of blending; a step would be a hundred
}

}  // namespace
}  // namespace tensegric_fit::body_model
