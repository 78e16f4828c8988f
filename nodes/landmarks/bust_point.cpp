#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSearch = 0.030;    // m from where it is expected; twice the model's own error is 10 mm
constexpr double kApex = 0.045;      // m of skin that the bulge is fitted to
constexpr double kBump = 0.007;      // m: deviation of a Gaussian bump like a nipple in its areola
constexpr double kPatch = 0.028;     // m of skin that nipple and smooth surface are fitted to together
constexpr double kNear = 0.012;      // m: deviation of the nipple from where it is expected
constexpr double kStep = 0.004, kFineStep = 0.0015;  // m
constexpr double kExact = 0.0002;    // m; a mesh is not taken to be better than this
constexpr int kCubic = 10;           // terms

/// Skin seen along a direction: (u, v) across, w along.
struct Patch {
  Vector3d origin;
  Eigen::Matrix3d axes;
  std::vector<Vector3d> points;
};

Patch patch_of(const Surface& surface, const std::vector<Vector3d>& normals, const Vector3d& origin, const Vector3d& outward, double radius) {
  Patch patch{origin, {}, {}};
  const Vector3d u = Vector3d::UnitZ().cross(outward).normalized();
  patch.axes << u, outward.cross(u), outward;
  for (const int v : vertices_near(surface, origin, radius, [&](int i) { return surface.arm[i] < 0.5 && normals[i].dot(outward) > 0.3; }))
    patch.points.push_back(patch.axes.transpose() * (surface.mesh.vertices[v] - origin));
  return patch;
}

/// Apex of a quadric through the skin round (u, v); nothing where it is no maximum nearby.
std::optional<Vector3d> apex_near(const Patch& patch, const Vector2d& start, double radius) {
  Vector2d place = start;
  double height = 0;
  for (int pass = 0; pass < 5; ++pass) {
    std::vector<Vector3d> near;
    for (const Vector3d& p : patch.points)
      if ((p.head<2>() - place).norm() < radius) near.push_back(p);
    if (near.size() < 12) return std::nullopt;  // twice the unknowns
    Eigen::MatrixXd terms(near.size(), 6);
    Eigen::VectorXd heights(near.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Vector2d d = (near[i].head<2>() - place) / radius;
      terms.row(static_cast<int>(i)) << 1, d.x(), d.y(), d.x() * d.x(), d.x() * d.y(), d.y() * d.y();
      heights[static_cast<int>(i)] = near[i].z();
    }
    const Eigen::VectorXd c = terms.colPivHouseholderQr().solve(heights);
    Eigen::Matrix2d curvature;
    curvature << 2 * c[3], c[4], c[4], 2 * c[5];
    if (curvature.determinant() <= 0 || curvature.trace() >= 0) return std::nullopt;
    Vector2d top = -curvature.inverse() * Vector2d(c[1], c[2]);
    if (top.norm() > 1) top.normalize();
    height = c[0] + top.dot(Vector2d(c[1], c[2])) + 0.5 * top.dot(curvature * top);
    place += radius * top;
    if ((place - start).norm() > kSearch) return std::nullopt;
  }
  return Vector3d(place.x(), place.y(), height);
}

struct Bump {
  double clearness, top;
};

/// Least squares: cubic polynomial and a bump at (u, v).
Bump bump_at(const Patch& patch, const Vector2d& at) {
  std::vector<Vector3d> near;
  for (const Vector3d& p : patch.points)
    if ((p.head<2>() - at).norm() < kPatch) near.push_back((p - Vector3d(at.x(), at.y(), 0)) / kPatch);
  const int count = static_cast<int>(near.size()), spare = count - kCubic - 1;
  if (spare < kCubic) return {0, 0};
  Eigen::MatrixXd terms(count, kCubic + 1);
  Eigen::VectorXd heights(count);
  for (int i = 0; i < count; ++i) {
    const double u = near[i].x(), v = near[i].y();
    terms.row(i) << 1, u, v, u * u, u * v, v * v, u * u * u, u * u * v, u * v * v, v * v * v,
        std::exp(-0.5 * (u * u + v * v) * std::pow(kPatch / kBump, 2));
    heights[i] = near[i].z();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(terms);
  Eigen::VectorXd projected = qr.householderQ().transpose() * heights;
  const Eigen::VectorXd c = qr.matrixQR().topRows(kCubic + 1).triangularView<Eigen::Upper>().solve(projected.head(kCubic + 1));
  const double variance = projected.tail(spare).squaredNorm() / spare + std::pow(kExact / kPatch, 2);
  const double sign = qr.matrixQR()(kCubic, kCubic) < 0 ? -1 : 1;
  return {sign * projected[kCubic] / std::sqrt(variance), kPatch * (c[0] + c[kCubic])};
}

}  // namespace

BustPoint find_bust_point(const Surface& surface, const Vector3d& expected, const Vector3d& outward) {
  const std::vector<Vector3d> normals = geometry::vertex_normals(surface.mesh.vertices, surface.mesh.triangles);
  const Patch patch = patch_of(surface, normals, expected, outward, kSearch + kApex);
  const auto in_frame = [&](const Vector3d& p) -> Vector3d { return patch.origin + patch.axes * p; };
  BustPoint found{expected, std::nullopt, 0};
  if (const auto apex = apex_near(patch, Vector2d::Zero(), kApex)) found.apex = in_frame(*apex);
  Vector2d best = Vector2d::Zero();
  double most = 0;
  const auto look = [&](const Vector2d& centre, double step, double reach) {
    const int steps = static_cast<int>(reach / step);
    for (int i = -steps; i <= steps; ++i)
      for (int j = -steps; j <= steps; ++j) {
        if (i * i + j * j > steps * steps) continue;
        const Vector2d place = centre + step * Vector2d(i, j);
        const Bump bump = bump_at(patch, place);
        const double weight = bump.clearness * std::exp(-0.5 * place.squaredNorm() / (kNear * kNear));
        if (weight <= most) continue;
        most = weight;
        best = place;
        found.clearness = bump.clearness;
        found.nipple = in_frame({place.x(), place.y(), bump.top});
      }
  };
  look(Vector2d::Zero(), kStep, kSearch);
  if (found.nipple) look(Vector2d(best), kFineStep, kStep);
  return found;
}

}  // namespace tensegric_fit::landmarks
