#include "landmarks/stoop.hpp"

#include <cmath>

#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;

// The line from the neck's back down the upper back, over so much of it, leans forward by this on an upright
// body: a heavier one, told by its neck, has more on its neck. A stoop bends the spine within that stretch
// too.
constexpr double kUpperBack = 0.12;
constexpr double kBendWithin = 1.12;
constexpr double kCoarse = 0.04;  // metres: no triangle of a measured mesh is larger
double upright_back(double neck_girth) {
  return (3.5 + 190 * (neck_girth - 0.188)) * kDegree;
}

}  // namespace

double stoop_of(const BodyShape& body, const Neck& neck) {
  const double s = body.stature;
  const Vector3d top = find_neck_back(body, neck), reach(0.12 * s, kCoarse, kUpperBack * s + kCoarse);
  Vector3d back = top;
  const std::vector<int> skin = triangles_in_box(body, top - reach, top + reach);
  for (const geometry::SectionLoop& loop : cut(body, skin, top, Vector3d::UnitY()))
    for (std::size_t i = loop.closed ? 0 : 1; i < loop.points.size(); ++i) {
      const Vector3d &a = loop.points[(i == 0 ? loop.points.size() : i) - 1], &b = loop.points[i];
      const double beyond_a = (a - top).norm() - kUpperBack * s, beyond_b = (b - top).norm() - kUpperBack * s;
      if ((beyond_a > 0) == (beyond_b > 0)) continue;
      const Vector3d p = a + beyond_a / (beyond_a - beyond_b) * (b - a);
      if (p.z() < top.z() && p.x() < neck.origin.x() && (back == top || p.x() < back.x())) back = p;
    }
  if (back == top) return neck.turn;
  return kBendWithin * (std::atan2(top.x() - back.x(), top.z() - back.z()) - upright_back(neck.girth / s));
}

}  // namespace tensegric_fit::landmarks
