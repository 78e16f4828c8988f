#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "landmarks/finders.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector2d;

constexpr double kSearch = 2.5;   // deviations from where it is expected
constexpr double kBump = 0.007;   // m: deviation of a Gaussian bump like a nipple in its areola
constexpr double kPatch = 0.028;  // m of skin that nipple and smooth surface are fitted to together
constexpr double kSteps = 7, kFineSteps = 3;  // from the middle of a search to its end
constexpr double kExact = 0.0002;             // m; a mesh is not taken to be better than this
constexpr double kClear = 5;                  // deviations; over all places, noise alone reaches 4
constexpr int kCubic = 10;                    // terms

/// Skin seen along a direction: (u, v) across, w along.
struct Patch {
  Vector3d origin;
  Eigen::Matrix3d axes;
  std::vector<Vector3d> points;
};

Patch patch_of(const Surface& surface, const std::vector<Vector3d>& normals, const Vector3d& origin,
               const Vector3d& outward, double radius) {
  Patch patch{origin, {}, {}};
  const Vector3d u = Vector3d::UnitZ().cross(outward).normalized();
  patch.axes << u, outward.cross(u), outward;
  for (const int v : vertices_near(surface, origin, radius, [&](int i) {
         return surface.arm[i] < 0.5 && normals[i].dot(outward) > 0.3;
       }))
    patch.points.push_back(patch.axes.transpose() * (surface.mesh.vertices[v] - origin));
  return patch;
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
  const Eigen::VectorXd c =
      qr.matrixQR().topRows(kCubic + 1).triangularView<Eigen::Upper>().solve(projected.head(kCubic + 1));
  const double variance = projected.tail(spare).squaredNorm() / spare + std::pow(kExact / kPatch, 2);
  const double sign = qr.matrixQR()(kCubic, kCubic) < 0 ? -1 : 1;
  return {sign * projected[kCubic] / std::sqrt(variance), kPatch * (c[0] + c[kCubic])};
}

}  // namespace

std::optional<Nipple> find_nipple(const Surface& surface, const Vector3d& expected, double deviation,
                                  const Vector3d& outward) {
  const std::vector<Vector3d> normals =
      geometry::vertex_normals(surface.mesh.vertices, surface.mesh.triangles);
  const Patch patch = patch_of(surface, normals, expected, outward, kSearch * deviation + kPatch);
  Vector2d best = Vector2d::Zero();
  Bump clearest{0, 0};
  double most = 0;
  const auto look = [&](const Vector2d& centre, double reach, double steps) {
    for (double i = -steps; i <= steps; ++i)
      for (double j = -steps; j <= steps; ++j) {
        const Vector2d place = centre + reach / steps * Vector2d(i, j);
        if ((place - centre).norm() > reach) continue;
        const Bump bump = bump_at(patch, place);
        const double weight = bump.clearness * std::exp(-0.5 * place.squaredNorm() / (deviation * deviation));
        if (weight <= most) continue;
        most = weight;
        best = place;
        clearest = bump;
      }
  };
  look(Vector2d::Zero(), kSearch * deviation, kSteps);
  look(Vector2d(best), kSearch * deviation / kSteps, kFineSteps);
  if (clearest.clearness < kClear) return std::nullopt;
  return Nipple{patch.origin + patch.axes * Vector3d(best.x(), best.y(), clearest.top),
                kBump / clearest.clearness};
}

}  // namespace tensegric_fit::landmarks
