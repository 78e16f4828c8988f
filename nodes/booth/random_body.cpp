#include "booth/random_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "booth/random.hpp"

namespace tensegric_fit::booth {
namespace {

using Eigen::Vector3d;

class Lot {
 public:
  explicit Lot(std::uint64_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  bool chance(double share) { return random_.uniform() < share; }
  double normal() { return random_.normal(); }

 private:
  Random random_;
};

}  // namespace

BodyParameters random_body(std::uint64_t seed) {
  Lot lot(seed);
  BodyParameters body;
  body.stature = std::clamp(1.64 + 0.065 * lot.normal(), 1.50, 1.80);
  // One figure for how heavy she is; the rest follows it loosely
  const double weight = lot.between(0, 1);
  body.build = 0.90 + 0.50 * weight + lot.between(-0.04, 0.04);
  body.bust = 0.88 + 0.42 * weight + lot.between(-0.10, 0.15);
  body.firmness = std::clamp(0.9 - 0.8 * weight + lot.between(-0.5, 0.2), -0.6, 1.0);
  body.asymmetry = std::clamp(0.05 * lot.normal(), -0.15, 0.15);
  body.waist = 1.0 + 0.12 * weight + lot.between(-0.05, 0.08);
  body.belly = lot.chance(0.5) ? lot.between(0.0, 0.3 + 0.7 * weight) : 0;
  body.hip = 1.0 + lot.between(-0.05, 0.12);
  body.stoop = lot.chance(0.25) ? lot.between(0.10, 0.38) : lot.between(-0.05, 0.08);
  // Arms as near to the trunk as its breadth allows; one in six holds them out
  const double least = 0.27 + 0.35 * std::max(0.0, body.build * body.hip - 1.10);
  body.arm_angle = lot.chance(1.0 / 6) ? lot.between(0.9, 1.396) : least + lot.between(0.0, 0.4);
  body.yaw = lot.chance(0.5) ? lot.between(-M_PI, M_PI) : 0;
  body.tilt = lot.chance(0.25) ? lot.between(-0.10, 0.10) : 0;
  return body;
}

ScannerOptions random_scanner(std::uint64_t seed, const VirtualBody& body) {
  constexpr std::uint64_t kOtherStream = 0x5ca77e12ull;  // than the body's
  Lot lot(seed ^ kOtherStream);
  ScannerOptions scanner;
  constexpr std::array<std::array<int, 2>, 4> kBooths = {{{4, 2}, {5, 2}, {4, 3}, {6, 2}}};
  const auto [columns, sensors] = kBooths[static_cast<std::size_t>(lot.between(0, kBooths.size()))];
  scanner.columns = columns;
  scanner.sensors_per_column = sensors;
  scanner.points = static_cast<int>(lot.chance(0.2) ? lot.between(40e3, 60e3) : lot.between(90e3, 250e3));
  scanner.noise = lot.between(0.0005, 0.0015);
  scanner.outliers = lot.between(0, 0.005);
  scanner.misregistration = lot.between(0.0002, 0.0008);  // along each axis, deviation
  scanner.floor = lot.chance(0.7);
  scanner.floor_radius = lot.between(0.6, 1.2);
  scanner.frame = lot.chance(0.4);
  scanner.seed = seed;

  const geometry::BodyMeasures& truth = body.truth;
  const Vector3d up = truth.body_from_scan.linear().row(2);
  if (up.head<2>().norm() > 1e-9)  // a frame that leans: nobody stands stiff on the edges of her soles
    scanner.booth_from_scan = Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()) *
                              Eigen::Translation3d(-truth.body_from_scan.inverse().translation());
  const double stature = truth.height("stature");
  const auto in_scan = [&truth](const Vector3d& p) -> Vector3d { return truth.body_from_scan.inverse() * p; };
  if (lot.chance(0.5)) {  // hair: the head but for the face
    const Vector3d nape = truth.body_from_scan * truth.landmark("neck_back");
    scanner.dark.push_back({in_scan(nape + stature * Vector3d(0.01, 0, 0.11)),
                            stature * Vector3d(0.075, 0.075, 0.085), lot.between(0.5, 0.9)});
  }
  if (lot.chance(0.3))  // briefs
    scanner.dark.push_back({in_scan({0, 0, truth.height("crotch") + 0.035 * stature}),
                            stature * Vector3d(0.15, 0.15, 0.04), lot.between(0.4, 0.8)});
  if (lot.chance(0.3)) {
    const double x = lot.normal(), y = lot.normal(), z = lot.normal();  // in this order
    scanner.fracture.centre = truth.landmark(lot.chance(0.5) ? "axilla_L" : "axilla_R");
    scanner.fracture.radii = Vector3d(0.14, 0.14, 0.16);
    scanner.fracture.shift = lot.between(0.005, 0.015) * Vector3d(x, y, z).normalized();
    scanner.fracture.from_column = scanner.columns / 2;
  }
  return scanner;
}

}  // namespace tensegric_fit::booth
