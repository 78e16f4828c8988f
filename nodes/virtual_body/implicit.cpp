#include "virtual_body/implicit.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::virtual_body {

Eigen::Vector3d Implicit::gradient(const Eigen::Vector3d& p) const {
  constexpr double step = 1e-5;
  Eigen::Vector3d g;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
    g[i] = (value(p + d) - value(p - d)) / (2 * step);
  }
  return g;
}

Eigen::Vector3d Implicit::project(Eigen::Vector3d p, const Eigen::Vector3d& mask) const {
  // Newton steps; the direction is good for several of them
  constexpr int kSteps = 12, kSameDirection = 4;
  constexpr double kClose = 1e-8, kLongestStep = 0.01, kFlat = 0.05;
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double v = value(p);
    if (std::abs(v) < kClose) break;
    if (i % kSameDirection == 0) g = gradient(p).cwiseProduct(mask);
    const double length = g.norm();
    if (length < kFlat) break;
    p -= std::clamp(v / length, -kLongestStep, kLongestStep) * g / length;
  }
  return p;
}

double smooth_union(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * h * k / 6;
}

double smooth_intersection(double a, double b, double k) {
  return -smooth_union(-a, -b, k);
}

double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& radii) {
  // First-order distance: (rho - 1) rho / |grad of rho^2 / 2|
  const Eigen::Vector3d q = p.cwiseQuotient(radii);
  const double rho = q.norm(), gradient = q.cwiseQuotient(radii).norm();
  return gradient < 1e-12 ? -radii.minCoeff() : rho * (rho - 1) / gradient;
}

double tapered_capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       double radius_a, double radius_b) {
  const Eigen::Vector3d axis = b - a;
  const double t = std::clamp((p - a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (p - a - t * axis).norm() - (radius_a + t * (radius_b - radius_a));
}

Loft::Loft(const std::vector<Section>& sections, double rounding) : rounding_(rounding) {
  for (const Section& s : sections) {
    z_.push_back(s.z);
    Values value;
    value << (s.front + s.back) / 2, (s.left + s.right) / 2, (s.front - s.back) / 2, (s.left - s.right) / 2,
        s.exponent;
    value_.push_back(value);
    box_.extend(Eigen::Vector3d(s.back, s.right, s.z));
    box_.extend(Eigen::Vector3d(s.front, s.left, s.z));
  }
  // Tangents of the parabola through each section and its neighbours
  const std::size_t count = z_.size();
  const auto chord = [this](std::size_t i) {
    return Values((value_[i + 1] - value_[i]) / (z_[i + 1] - z_[i]));
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || i + 1 == count) {
      slope_.push_back(chord(i == 0 ? 0 : i - 1));
    } else {
      const double below = z_[i] - z_[i - 1], above = z_[i + 1] - z_[i];
      slope_.push_back((chord(i - 1) * above + chord(i) * below) / (below + above));
    }
  }
}

void Loft::at(double z, Values& value, Values& slope) const {
  const auto upper = std::upper_bound(z_.begin() + 1, z_.end() - 1, z);
  const std::size_t i = static_cast<std::size_t>(upper - z_.begin()) - 1;
  const double h = z_[i + 1] - z_[i], t = (z - z_[i]) / h, s = 1 - t;
  value = (1 + 2 * t) * s * s * value_[i] + t * s * s * h * slope_[i] + (1 + 2 * s) * t * t * value_[i + 1] -
          s * t * t * h * slope_[i + 1];
  slope = 6 * t * s / h * (value_[i + 1] - value_[i]) + s * (s - 2 * t) * slope_[i] +
          t * (t - 2 * s) * slope_[i + 1];
}

double Loft::operator()(const Eigen::Vector3d& p) const {
  constexpr double kFar = 0.1;
  const double outside = box_.exteriorDistance(p);
  if (outside > kFar) return outside;
  Values v, d;
  at(std::clamp(p.z(), z_.front(), z_.back()), v, d);
  const double dx = p.x() - v[0], dy = p.y() - v[1], distance = std::hypot(dx, dy);
  const double a = std::pow(std::abs(dx) / v[2], v[4]), b = std::pow(std::abs(dy) / v[3], v[4]);
  const double rho = std::pow(a + b, 1 / v[4]);
  double radial = -std::min(v[2], v[3]);
  if (rho > 1e-6) {
    // From the axis the surface is `reach` away in this direction; its slope over z turns the gap into a
    // distance.
    const double reach = distance / rho;
    const double lean =
        reach * (a * d[2] / v[2] + b * d[3] / v[3]) / (a + b) + (dx * d[0] + dy * d[1]) / distance;
    radial = (distance - reach) / std::sqrt(1 + lean * lean);
  }
  return smooth_intersection(smooth_intersection(radial, z_.front() - p.z(), rounding_), p.z() - z_.back(),
                             rounding_);
}

}  // namespace tensegric_fit::virtual_body
