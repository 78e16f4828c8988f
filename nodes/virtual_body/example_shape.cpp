#include "virtual_body/example_shape.hpp"

#include <cmath>

#include "geometry/status.hpp"
#include "virtual_body/implicit.hpp"
#include "virtual_body/polygonise.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

class Torus : public Implicit {
 public:
  double value(const Vector3d& p) const override {
    return std::hypot(std::hypot(p.x(), p.y()) - kRing, p.z()) - kTube;
  }
  Eigen::AlignedBox3d half_box() const override {
    constexpr double kReach = kRing + kTube + kRoom;
    return {Vector3d(-kReach, 0, -kTube), Vector3d(kReach, kReach, kTube + kRoom)};
  }

 private:
  static constexpr double kRing = 0.35, kTube = 0.11, kRoom = 0.02;
};

// A flat ellipsoid round `centre`, turned by `turn`.
double fin(const Vector3d& p, const Vector3d& centre, const Vector3d& radii, const Eigen::Quaterniond& turn) {
  return ellipsoid(turn.conjugate() * (p - centre), radii);
}

// Swims along x.
class Dolphin : public Implicit {
 public:
  Dolphin()
      : trunk_({{-0.470, -0.013, 0.013, -0.011, 0.011},
                {-0.380, -0.022, 0.022, -0.014, 0.014},
                {-0.260, -0.043, 0.045, -0.032, 0.032},
                {-0.120, -0.078, 0.078, -0.066, 0.066},
                {0.020, -0.100, 0.094, -0.092, 0.092},
                {0.160, -0.100, 0.092, -0.094, 0.094},
                {0.280, -0.082, 0.074, -0.076, 0.076},
                {0.360, -0.060, 0.046, -0.054, 0.054},
                {0.400, -0.045, 0.010, -0.034, 0.034},
                {0.450, -0.037, -0.004, -0.021, 0.021},
                {0.500, -0.030, -0.008, -0.014, 0.014}},
               0.02) {}

  double value(const Vector3d& p) const override {
    const Vector3d q(p.x(), std::abs(p.y()), p.z());
    const double dorsal = fin(q, {-0.030, 0, 0.095}, {0.045, 0.011, 0.085},
                              Eigen::Quaterniond(AngleAxisd(-0.75, Vector3d::UnitY())));
    const double flipper = fin(q, {0.150, 0.110, -0.085}, {0.036, 0.090, 0.011},
                               AngleAxisd(0.60, Vector3d::UnitZ()) * AngleAxisd(-0.55, Vector3d::UnitX()));
    const double fluke = fin(q, {-0.478, 0.058, 0}, {0.036, 0.095, 0.010},
                             Eigen::Quaterniond(AngleAxisd(0.50, Vector3d::UnitZ())));
    double shape = trunk_({q.z(), q.y(), q.x()});  // the sections are stacked along x
    for (double part : {dorsal, flipper, fluke}) shape = smooth_union(shape, part, 0.03);
    return shape;
  }
  Eigen::AlignedBox3d half_box() const override {
    return {Vector3d(-0.58, 0, -0.18), Vector3d(0.53, 0.24, 0.20)};
  }

 private:
  Loft trunk_;
};

ExampleShape held(const Implicit& shape, double up_to, double spacing) {
  constexpr double kFar = 1;
  return {polygonise(shape, spacing), {Vector3d(-kFar, -kFar, -kFar), Vector3d(up_to, kFar, kFar)}};
}

}  // namespace

const std::vector<std::string>& example_shapes() {
  static const std::vector<std::string> names{"dolphin", "torus"};
  return names;
}

ExampleShape make_example_shape(const std::string& name) {
  if (name == "dolphin") return held(Dolphin(), -0.36, 0.006);
  if (name == "torus") return held(Torus(), -0.36, 0.010);
  throw geometry::Refusal(geometry::refusal::kBadOption,
                          "there is no example shape '" + name + "'; there are dolphin and torus");
}

}  // namespace tensegric_fit::virtual_body
