#include "reconstruction/visibility.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/parallel_for.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr double kPixel = 0.012;  // m; several points' spacing, so that the surface is opaque
constexpr double kSlack = 0.015;  // m; how far behind the nearest point of its pixel a point counts as seen
constexpr int kEyes = 64;
constexpr double kLowestEye =
    -0.5;  // sine of the elevation: from farther below the unseen soles let one look inside

/// Directions spread evenly over the sphere by the golden angle.
std::vector<Eigen::Vector3d> eyes() {
  std::vector<Eigen::Vector3d> result;
  for (int i = 0; i < kEyes; ++i) {
    const double z = kLowestEye + (1 - kLowestEye) * (i + 0.5) / kEyes, r = std::sqrt(1 - z * z);
    const double turn = i * M_PI * (3 - std::sqrt(5.0));
    result.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return result;
}

/// Adds one eye's direction to the points that it sees.
void look(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& eye,
          std::vector<Eigen::Vector3d>& seen) {
  std::vector<Eigen::Vector3d> image(points.size());  // across, up, towards the eye
  const Eigen::Vector3d across = eye.unitOrthogonal(), up = eye.cross(across);
  for (std::size_t i = 0; i < points.size(); ++i)
    image[i] = {across.dot(points[i]), up.dot(points[i]), eye.dot(points[i])};
  const auto box = geometry::bounding_box(image);
  const int width = static_cast<int>((box[1].x() - box[0].x()) / kPixel) + 1;
  const int height = static_cast<int>((box[1].y() - box[0].y()) / kPixel) + 1;
  const auto pixel = [&](const Eigen::Vector3d& p) {
    return static_cast<int>((p.y() - box[0].y()) / kPixel) * width +
           static_cast<int>((p.x() - box[0].x()) / kPixel);
  };
  std::vector<double> nearest(static_cast<std::size_t>(width) * height,
                              -std::numeric_limits<double>::infinity());
  for (const Eigen::Vector3d& p : image) nearest[pixel(p)] = std::max(nearest[pixel(p)], p.z());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (image[i].z() > nearest[pixel(image[i])] - kSlack) seen[i] += eye;
}

}  // namespace

std::vector<Eigen::Vector3d> seen_from(const std::vector<Eigen::Vector3d>& points) {
  std::array<std::vector<Eigen::Vector3d>, 2> seen;
  const std::vector<Eigen::Vector3d> all = eyes();
  geometry::parallel_for(all.size(), [&](std::size_t begin, std::size_t end, int half) {
    seen[half].assign(points.size(), Eigen::Vector3d::Zero());
    for (std::size_t e = begin; e < end; ++e) look(points, all[e], seen[half]);
  });
  for (std::size_t i = 0; i < points.size(); ++i) seen[0][i] += seen[1][i];
  return std::move(seen[0]);
}

}  // namespace tensegric_fit::reconstruction
