/// Building blocks of implicit shapes: functions that are negative inside, zero on the surface and close to
/// the distance in metres near it.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace tensegric_fit::virtual_body {

/// At y = 0.
inline Eigen::Vector3d mirrored(const Eigen::Vector3d& p) {
  return {p.x(), -p.y(), p.z()};
}

/// A shape that is its own mirror image at y = 0, or nearly so.
class Implicit {
 public:
  virtual ~Implicit() = default;

  virtual double value(const Eigen::Vector3d& p) const = 0;
  /// Holds all of the shape with y >= 0 and of the mirror image of the rest; starts at y = 0.
  virtual Eigen::AlignedBox3d half_box() const = 0;

  /// Central differences. Its length is near 1 at the skin.
  Eigen::Vector3d gradient(const Eigen::Vector3d& p) const;
  /// The skin point near `p`, by Newton steps along the gradient; `mask` zeroes the directions that p must
  /// keep.
  Eigen::Vector3d project(Eigen::Vector3d p, const Eigen::Vector3d& mask = Eigen::Vector3d::Ones()) const;
};

/// Union of two shapes whose crease is rounded over a distance of about `k` metres (cubic, twice
/// differentiable). Where the two differ by k or more it is the plain minimum. Commutative bit for bit. \pre
/// k > 0
double smooth_union(double a, double b, double k);

/// Intersection, rounded alike. \pre k > 0
double smooth_intersection(double a, double b, double k);

/// Ellipsoid round the origin with half axes `radii`. \pre all positive
double ellipsoid(const Eigen::Vector3d& p, const Eigen::Vector3d& radii);

/// Ball of radius `radius_a` at `a` rolled into one of radius `radius_b` at `b`.
double tapered_capsule(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       double radius_a, double radius_b);

/// A superellipse in the plane at height z: |x - cx|^n / rx^n + |y - cy|^n / ry^n = 1.
struct Section {
  double z;
  double back, front;   ///< least and greatest x
  double right, left;   ///< least and greatest y
  double exponent = 2;  ///< n: 2 is an ellipse, more is boxier
};

/// A body through horizontal sections, smooth in between, ending with an edge rounded over `rounding` metres.
/// Farther than 0.1 m from the box round its sections the value is the distance from that box.
class Loft {
 public:
  /// \pre two sections or more, z ascending, every extent positive
  Loft(const std::vector<Section>& sections, double rounding);
  double operator()(const Eigen::Vector3d& p) const;

 private:
  using Values = Eigen::Array<double, 5, 1>;  // cx, cy, rx, ry, n
  void at(double z, Values& value, Values& slope) const;

  std::vector<double> z_;
  std::vector<Values> value_, slope_;
  double rounding_;
  Eigen::AlignedBox3d box_;
};

}  // namespace tensegric_fit::virtual_body
