#include "landmarks/nipple.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

// In statures.
constexpr double kWidth = 0.0043;   // 7 mm: deviation of a Gaussian bump like a nipple in its areola
constexpr double kPatch = 0.017;    // 28 mm: skin that the smooth surface is fitted to
constexpr double kSearch = 0.0185;  // 30 mm: how far nipples lie from where the breast points
constexpr double kNear = 0.012;     // 20 mm: deviation of that
constexpr double kStep = 0.0024, kFineStep = 0.001;
constexpr double kExact = 0.0002;  // m; a mesh is not taken to be better than this
constexpr double kClear = 5;       // deviations; over all places, noise alone reaches 4
constexpr int kSmoothTerms = 10;

// Skin seen along its mean normal: (u, v) across, w along, relative to `origin`.
struct Skin {
  Vector3d origin;
  Eigen::Matrix3d axes;  // columns u, v, w
  std::vector<Vector3d> points;
};

struct Bump {
  double clearness = 0;  // height by its standard deviation
  double top = 0;        // w of the fitted surface with the bump on it
};

Skin skin_around(const BodyShape& body, const Vector3d& origin, double radius) {
  std::vector<int> near;
  Vector3d normal = Vector3d::Zero();
  for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v) {
    if ((body.mesh.vertices[v] - origin).squaredNorm() > radius * radius) continue;
    near.push_back(static_cast<int>(v));
    normal += body.normals[v];
  }
  Skin skin{origin, Eigen::Matrix3d::Identity(), {}};
  if (normal.head<2>().norm() < 1e-9) return skin;
  normal.normalize();
  const Vector3d u = Vector3d::UnitZ().cross(normal).normalized();  // level: both sides are searched alike
  skin.axes << u, normal.cross(u), normal;
  for (int v : near)  // not the skin that has turned away, as under an overhang
    if (body.normals[v].dot(normal) > 0.3)
      skin.points.push_back(skin.axes.transpose() * (body.mesh.vertices[v] - origin));
  return skin;
}

// Least squares: cubic polynomial and a bump at (u, v).
Bump bump_at(const Skin& skin, double u, double v, double stature) {
  const double patch = kPatch * stature;
  std::vector<Vector3d> points;  // in patches
  for (const Vector3d& p : skin.points) {
    const Vector3d q = (p - Vector3d(u, v, 0)) / patch;
    if (q.head<2>().squaredNorm() < 1) points.push_back(q);
  }
  const int count = static_cast<int>(points.size()), spare = count - kSmoothTerms - 1;
  if (spare < kSmoothTerms) return {};
  Eigen::MatrixXd terms(count, kSmoothTerms + 1);
  Eigen::VectorXd heights(count);
  for (int i = 0; i < count; ++i) {
    const double a = points[i].x(), b = points[i].y();
    const double bump = std::exp(-(a * a + b * b) * std::pow(kPatch / kWidth, 2) / 2);
    terms.row(i) << 1, a, b, a * a, a * b, b * b, a * a * a, a * a * b, a * b * b, b * b * b, bump;
    heights[i] = points[i].z();
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(terms);
  const Eigen::VectorXd projected = qr.householderQ().transpose() * heights;
  const auto r = qr.matrixQR().topRows(kSmoothTerms + 1).triangularView<Eigen::Upper>();
  if (qr.matrixQR().diagonal().cwiseAbs().minCoeff() < 1e-6) return {};
  const Eigen::VectorXd c = r.solve(projected.head(kSmoothTerms + 1));
  // The bump's term is the last: its part of `projected` is its height by its standard deviation.
  const double variance = projected.tail(spare).squaredNorm() / spare + std::pow(kExact / patch, 2);
  const double down = qr.matrixQR()(kSmoothTerms, kSmoothTerms) < 0 ? -1 : 1;
  return {down * projected[kSmoothTerms] / std::sqrt(variance), patch * (c[0] + c[kSmoothTerms])};
}

}  // namespace

std::optional<Vector3d> find_nipple(const BodyShape& body, const Vector3d& apex) {
  const double s = body.stature;
  const Skin skin = skin_around(body, apex, (kSearch + kStep + kPatch) * s);
  Eigen::Vector2d best(0, 0);
  Bump clearest;
  double most = 0;
  const auto look = [&](const Eigen::Vector2d& centre, double step, double reach) {
    const int steps = static_cast<int>(reach / step);
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        if (i * i + j * j > steps * steps) continue;
        const Eigen::Vector2d place = centre + step * s * Eigen::Vector2d(i, j);
        const Bump bump = bump_at(skin, place.x(), place.y(), s);
        const double weight = std::exp(-0.5 * place.squaredNorm() / std::pow(kNear * s, 2));
        if (bump.clearness * weight <= most) continue;
        most = bump.clearness * weight;
        best = place;
        clearest = bump;
      }
    }
  };
  look(Eigen::Vector2d::Zero(), kStep, kSearch);
  look(Eigen::Vector2d(best), kFineStep, kStep);
  if (clearest.clearness <= kClear) return std::nullopt;
  return skin.origin + skin.axes * Vector3d(best.x(), best.y(), clearest.top);
}

}  // namespace tensegric_fit::landmarks
