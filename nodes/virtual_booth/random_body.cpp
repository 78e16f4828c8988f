#include "virtual_booth/random_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "body_model/registered_body.hpp"
#include "geometry/rigid_motion.hpp"
#include "geometry/side.hpp"
#include "geometry/status.hpp"
#include "virtual_body/random.hpp"
#include "virtual_body/sagittal.hpp"

namespace tensegric_fit::virtual_booth {
namespace {

using Eigen::Vector3d;

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  bool chance(double share) { return random_.uniform() < share; }
  double normal() { return random_.normal(); }
  /// Standard normal, none beyond `limit`.
  double normal_within(double limit) {
    double value = normal();
    while (std::abs(value) > limit) value = normal();
    return value;
  }

 private:
  virtual_body::Random random_;
};

constexpr double kDegree = M_PI / 180;

/// Of either family.
double random_stature(Draw& draw) {
  return std::clamp(1.64 + 0.065 * draw.normal(), 1.50, 1.80);
}

/// Whether the girth round her bust points lies within the span of the women that the model was trained on.
bool is_womans_size(const body_model::Model& model, const virtual_body::ModelBodyParameters& body) {
  const virtual_body::Skin skin({virtual_body::stand(model, body).vertices, model.triangles}, model.arm);
  double height = 0;
  for (const char* name : {"bust_point_L", "bust_point_R"})
    height += body_model::skin_point(model, skin.mesh().vertices, name).z() / 2;
  const double bust = virtual_body::girth(skin.round_trunk(height));
  return bust > 0.70 && bust < 1.42;  // m
}

/// Opens arms and legs step by step until they are clear of each other, or as far as a booth asks for: broad
/// hips may be in the way of arms even then.
void part_limbs(const body_model::Model& model, virtual_body::ModelBodyParameters& body) {
  constexpr double kStep = 3 * kDegree, kWidestArms = 60 * kDegree, kWidestLegs = 6 * kDegree;
  for (;;) {
    const virtual_body::Collisions collided =
        virtual_body::collisions(model, virtual_body::stand(model, body).vertices);
    bool moved = false;
    const auto open = [&](bool wanted, double& angle, double widest) {
      if (!wanted || angle >= widest) return;
      angle = std::min(angle + kStep, widest);
      moved = true;
    };
    for (const geometry::Side side : geometry::kSides)
      open(collided.arms[side], body.arms[side], kWidestArms);
    open(collided.legs, body.legs, kWidestLegs);
    if (!moved) return;
  }
}

virtual_body::ModelBodyParameters draw_model_body(Draw& draw, const body_model::Model& model) {
  virtual_body::ModelBodyParameters body;
  body.shape.resize(model.components());
  do {  // odd combinations are drawn again
    for (double& coefficient : body.shape) coefficient = draw.normal_within(2.5);
    body.stature = random_stature(draw);
  } while (!is_womans_size(model, body));
  // Mostly the pose that a booth asks for; one in four holds her arms wider
  const double arms = draw.chance(0.25) ? draw.between(38, 60) : draw.between(10, 38),
               elbows = draw.between(5, 35);
  for (const geometry::Side side : geometry::kSides) {
    body.arms[side] = std::clamp(arms + 3 * draw.normal_within(2), 10.0, 60.0) * kDegree;
    body.forwards[side] = 5 * kDegree * draw.normal_within(2);
    body.elbows[side] = std::clamp(elbows + 4 * draw.normal_within(2), 0.0, 45.0) * kDegree;
  }
  body.legs = draw.between(-6, 2) * kDegree;
  body.lean = (0.5 + 1.5 * draw.normal_within(2.5)) * kDegree;
  body.bend = 1.2 * kDegree * draw.normal_within(2.5);
  body.twist = 2 * kDegree * draw.normal_within(2.5);
  part_limbs(model, body);
  return body;
}

struct Woman {
  virtual_body::ModelBodyParameters parameters;
  virtual_body::VirtualBody body;
};

/// The first that the seed draws of whom a body can be made: arms may run into it however wide they are, and
/// a flat chest has no fold. Only making it shows that.
Woman random_woman(std::uint64_t seed, const body_model::Model& model, double yaw, double tilt) {
  constexpr int kMostDraws = 20;
  Draw draw(seed);
  for (int count = 1;; ++count) {
    Woman woman{draw_model_body(draw, model), {}};
    woman.parameters.yaw = yaw;
    woman.parameters.tilt = tilt;
    try {
      woman.body = virtual_body::make_body(model, woman.parameters);
      return woman;
    } catch (const geometry::Refusal&) {
      if (count == kMostDraws) throw;
    }
  }
}

}  // namespace

const std::vector<std::string>& families() {
  static const std::vector<std::string> names{"model", "implicit"};
  return names;
}

Family family_named(const std::string& name) {
  for (std::size_t i = 0; i < families().size(); ++i)
    if (families()[i] == name) return static_cast<Family>(i);
  throw geometry::Refusal(geometry::refusal::kBadOption,
                          "there is no body family '" + name + "'; there are model and implicit");
}

virtual_body::VirtualBody random_customer(Family family, std::uint64_t seed) {
  if (family == Family::implicit) return virtual_body::make_body(random_body(seed));
  constexpr std::uint64_t kOtherStream = 0xb0d7f4a3ull;  // than the shape's
  Draw draw(seed ^ kOtherStream);
  const double yaw = draw.chance(0.5) ? draw.between(-M_PI, M_PI) : 0;
  const double tilt = draw.chance(0.25) ? draw.between(-0.10, 0.10) : 0;
  return random_woman(seed, virtual_body::shipped_model(), yaw, tilt).body;
}

virtual_body::ModelBodyParameters random_model_body(std::uint64_t seed, const body_model::Model& model) {
  return random_woman(seed, model, 0, 0).parameters;
}

virtual_body::BodyParameters random_body(std::uint64_t seed) {
  Draw draw(seed);
  virtual_body::BodyParameters body;
  body.stature = random_stature(draw);
  // One figure for how heavy she is; the rest follows it loosely
  const double weight = draw.between(0, 1);
  body.build = 0.90 + 0.50 * weight + draw.between(-0.04, 0.04);
  body.bust = 0.88 + 0.42 * weight + draw.between(-0.10, 0.15);
  body.firmness = std::clamp(0.9 - 0.8 * weight + draw.between(-0.5, 0.2), -0.6, 1.0);
  body.asymmetry = std::clamp(0.05 * draw.normal(), -0.15, 0.15);
  body.waist = 1.0 + 0.12 * weight + draw.between(-0.05, 0.08);
  body.belly = draw.chance(0.5) ? draw.between(0.0, 0.3 + 0.7 * weight) : 0;
  body.hip = 1.0 + draw.between(-0.05, 0.12);
  body.stoop = draw.chance(0.25) ? draw.between(0.10, 0.38) : draw.between(-0.05, 0.08);
  // Arms as near to the trunk as its breadth allows; one in six holds them out
  const double least = 0.27 + 0.35 * std::max(0.0, body.build * body.hip - 1.10);
  body.arm_angle = draw.chance(1.0 / 6) ? draw.between(0.9, 1.396) : least + draw.between(0.0, 0.4);
  body.yaw = draw.chance(0.5) ? draw.between(-M_PI, M_PI) : 0;
  body.tilt = draw.chance(0.25) ? draw.between(-0.10, 0.10) : 0;
  return body;
}

ScannerOptions random_scanner(std::uint64_t seed, const virtual_body::VirtualBody& body) {
  constexpr std::uint64_t kOtherStream = 0x5ca77e12ull;  // than the body's
  Draw draw(seed ^ kOtherStream);
  ScannerOptions scanner;
  constexpr std::array<std::array<int, 2>, 4> kBooths = {{{4, 2}, {5, 2}, {4, 3}, {6, 2}}};
  const auto [columns, sensors] = kBooths[static_cast<std::size_t>(draw.between(0, kBooths.size()))];
  scanner.columns = columns;
  scanner.sensors_per_column = sensors;
  scanner.points = static_cast<int>(draw.chance(0.2) ? draw.between(40e3, 60e3) : draw.between(90e3, 250e3));
  scanner.noise = draw.between(0.0005, 0.0015);
  scanner.outliers = draw.between(0, 0.005);
  scanner.misregistration = draw.between(0.0002, 0.0008);  // along each axis, deviation
  scanner.floor = draw.chance(0.7);
  scanner.floor_radius = draw.between(0.6, 1.2);
  scanner.frame = draw.chance(0.4);
  scanner.seed = seed;

  const geometry::BodyMeasures& truth = body.truth;
  const Vector3d up = truth.body_from_scan.linear().row(2);
  if (up.head<2>().norm() > 1e-9)  // a frame that leans: nobody stands stiff on the edges of her soles
    scanner.booth_from_scan = geometry::shortest_turn(up, Vector3d::UnitZ()) *
                              Eigen::Translation3d(-truth.body_from_scan.inverse().translation());
  const double stature = truth.height("stature");
  const auto in_scan = [&truth](const Vector3d& p) -> Vector3d { return truth.body_from_scan.inverse() * p; };
  if (draw.chance(0.5)) {  // hair: the head but for the face
    const Vector3d nape = truth.body_from_scan * truth.landmark("neck_back");
    scanner.dark.push_back({in_scan(nape + stature * Vector3d(0.01, 0, 0.11)),
                            stature * Vector3d(0.075, 0.075, 0.085), draw.between(0.5, 0.9)});
  }
  if (draw.chance(0.3))  // briefs
    scanner.dark.push_back({in_scan({0, 0, truth.height("crotch") + 0.035 * stature}),
                            stature * Vector3d(0.15, 0.15, 0.04), draw.between(0.4, 0.8)});
  if (draw.chance(0.3)) {
    const double x = draw.normal(), y = draw.normal(), z = draw.normal();  // in this order
    scanner.fracture.centre = truth.landmark(draw.chance(0.5) ? "axilla_L" : "axilla_R");
    scanner.fracture.radii = Vector3d(0.14, 0.14, 0.16);
    scanner.fracture.shift = draw.between(0.005, 0.015) * Vector3d(x, y, z).normalized();
    scanner.fracture.from_column = scanner.columns / 2;
  }
  return scanner;
}

}  // namespace tensegric_fit::virtual_booth
