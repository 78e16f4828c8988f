// Cups: lines whose fibres spread over the skin.
#include <gtest/gtest.h>

#include "geometry/section.hpp"
#include "refusal_of.hpp"
#include "tffd/lay_line.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

Points rest_of(const geometry::Fibre& fibre) {
  Points points;
  for (const geometry::CarriedPoint& point : fibre.points) points.push_back(point.rest);
  return points;
}

constexpr double kRadius = 0.1;

Vector3d on_ball(double latitude, double longitude) {  // degrees
  const double up = latitude * M_PI / 180, around = longitude * M_PI / 180;
  return kRadius * Vector3d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up));
}

/// From the equator down to a row on both sides of its meridian; each way there makes a detour.
LineOnBody over_the_ball(double detour) {
  LineOnBody cup{{on_ball(0, 0)}, 0.03};
  for (const double longitude : {-40.0, 0.0, 40.0})
    cup.fan.push_back({on_ball(0, 0), on_ball(-25, longitude / 2 + detour), on_ball(-50, longitude)});
  return cup;
}

struct OnABall : testing::Test {
  const geometry::TriangleMesh body = sphere(kRadius, 120);  // 2.6 mm apart
  const geometry::ControlMesh control = ball();
  const Binding binding{body, control, {}};
  // Facets lie up to 2.6^2 / 8 / 100 mm inside the ball, 1e-4 of its radius.
  static constexpr double kFacets = 1e-4;
};

TEST_F(OnABall, FibresOfACupAreGreatCirclesFromItsWidthToEvenPlacesInItsRow) {
  const LineOnBody cup = over_the_ball(10);
  const auto fibres = lay_line(cup, body, binding);
  ASSERT_EQ(fibres.size(), 7u);
  double mean = 0, shares = 0, wanted = 0;
  for (int f = 0; f < 7; ++f) {
    // From right to left, which is +y as one goes down on the outside.
    const double beside = 0.03 * (f / 6.0 - 0.5) / kRadius, at = f / 3.0;
    const Vector3d from = kRadius * Vector3d(std::cos(beside), std::sin(beside), 0);
    const std::size_t segment = f < 3 ? 0 : 1;
    const Vector3d &a = cup.fan[segment].back(), &b = cup.fan[segment + 1].back();
    const Vector3d to = kRadius * (a + (at - segment) * (b - a)).normalized();
    const double arc = kRadius * std::acos(from.dot(to) / (kRadius * kRadius));
    const Points points = rest_of(fibres[f]);
    EXPECT_LT((points.front() - from).norm(), kFacets * kRadius) << f;
    // The row lies up to 2.5 mm below the skin; facets are tilted by up to 2.6 / 2 / 100 against the ball.
    EXPECT_LT((points.back() - to).norm(), 5e-5) << f;
    EXPECT_NEAR(geometry::length_of(points, false), arc, 2 * kFacets * arc) << f;
    const Vector3d square = from.cross(to).normalized();
    for (const Vector3d& point : points) EXPECT_LT(std::abs(square.dot(point)), 3e-4) << f;
    EXPECT_NEAR(fibres[f].share, f == 0 || f == 6 ? 1 / 12.0 : 1 / 6.0, 1e-12);  // even over the width
    shares += fibres[f].share;
    mean += fibres[f].share * geometry::length_of(points, false);
    wanted += (f == 0 || f == 6 ? 1 / 12.0 : 1 / 6.0) * arc;
  }
  EXPECT_NEAR(shares, 1, 1e-12);
  EXPECT_NEAR(mean, wanted, 2 * kFacets * wanted);
}

TEST_F(OnABall, ARowMayBeNamedFromEitherEnd) {
  LineOnBody cup = over_the_ball(0);
  const auto one = lay_line(cup, body, binding);
  std::reverse(cup.fan.begin(), cup.fan.end());
  const auto other = lay_line(cup, body, binding);
  for (std::size_t f = 0; f < one.size(); ++f) EXPECT_EQ(rest_of(one[f]), rest_of(other[f]));
}

TEST_F(OnABall, ABandMaySpreadWhereItEnds) {
  LineOnBody cup = over_the_ball(0);
  cup.points.insert(cup.points.begin(), {on_ball(40, 0), on_ball(20, 0)});
  LineOnBody strap = cup;
  strap.fan.clear();
  const auto spread = lay_line(cup, body, binding), band = lay_line(strap, body, binding);
  ASSERT_EQ(spread.size(), band.size());
  for (std::size_t f = 0; f < band.size(); ++f) {
    const Points points = rest_of(spread[f]), above = rest_of(band[f]);
    ASSERT_GT(points.size(), above.size());
    EXPECT_TRUE(std::equal(above.begin(), above.end(), points.begin()));
    EXPECT_EQ(points.back(), rest_of(lay_line(over_the_ball(0), body, binding)[f]).back());
  }
}

TEST_F(OnABall, RefusesByName) {
  LineOnBody off_the_skin = over_the_ball(0), without_length = off_the_skin;
  off_the_skin.fan.front().back() *= 1.5;
  without_length.width = 1e-3;
  for (auto& way : without_length.fan) way = {on_ball(0, 0), on_ball(0, way.back().y())};
  EXPECT_EQ(refusal_of([&] { lay_line(off_the_skin, body, binding); }), "bad_garment");
  EXPECT_EQ(refusal_of([&] { lay_line(without_length, body, binding); }), "bad_garment");
}

TEST(CupOnABump, OfTheOtherSideIsTheMirrorImage) {
  const geometry::TriangleMesh body = slab(121);
  const Binding binding(body, patch(), {});
  const auto at = [](double x, double y) { return Vector3d(x, y, bump(x, y)); };
  const auto laid = [&](double side) {
    LineOnBody cup{{at(0.01 * side, 0.01)}, 0.015, 0.02, false, {false, false}};
    for (const double x : {-0.03, 0.02, 0.06})
      cup.fan.push_back({cup.points.front(), at(0.5 * x * side, -0.03), at(x * side, -0.06)});
    return lay_line(cup, body, binding);
  };
  const auto left = laid(1), right = laid(-1);
  double widest = 0;
  for (std::size_t f = 0; f < left.size(); ++f) {
    const Points points = rest_of(left[f]), others = rest_of(right[left.size() - 1 - f]);
    ASSERT_EQ(points.size(), others.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT((points[i] - Vector3d(-others[i].x(), others[i].y(), others[i].z())).norm(), 1e-9);
    widest = std::max(widest, (points.back() - rest_of(left.front()).back()).norm());
  }
  EXPECT_GT(widest, 0.08);  // of 0.09 from end to end of the row
}

}  // namespace
}  // namespace tensegric_fit::tffd
