#include "inspect/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "geometry/status.hpp"
#include "inspect/raster.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kOversampling = 2;  // along each axis
constexpr double kLineLift =
    0.012;  // metres; between control nodes a line runs under the skin, but less than this
const cv::Scalar kBackground(255, 255, 255);

View view_along(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& forward_in_body,
                const Eigen::Vector3d& centre, double height) {
  const Eigen::Matrix3d scan_from_body = body_from_scan.linear().transpose();
  const Eigen::Vector3d forward = forward_in_body.normalized(), z = Eigen::Vector3d::UnitZ();
  return {scan_from_body * forward, scan_from_body * (z - forward * forward.z()).normalized(), centre,
          height};
}

// The picture's axes in the scan's frame as rows: right, down, forward.
Eigen::Matrix3d camera_axes(const View& view) {
  Eigen::Matrix3d axes;
  axes << view.forward.cross(view.up).transpose(), -view.up.transpose(), view.forward.transpose();
  return axes;
}

struct Camera {
  Camera(const View& view, int width, int height)
      : axes(camera_axes(view)),
        centre(view.centre),
        scale(height / view.height),
        middle(width / 2.0, height / 2.0) {}

  // x, y in pixels, depth in metres.
  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = axes * (point - centre);
    return {middle.x() + scale * p.x(), middle.y() + scale * p.y(), p.z()};
  }

  Eigen::Matrix3d axes;
  Eigen::Vector3d centre;
  double scale;
  Eigen::Vector2d middle;
};

// A soft lamp above the camera, sky from above and a little light from everywhere. `n` is unit, in camera
// axes.
double light_on(Eigen::Vector3d n) {
  static const Eigen::Vector3d to_lamp = Eigen::Vector3d(0, -0.55, -1).normalized();
  if (n.z() > 0) n = -n;  // both sides of the skin are lit alike
  const double lamp = std::max(0.0, n.dot(to_lamp)), sky = (1 - n.y()) / 2;
  return 0.30 + 0.56 * lamp + 0.26 * sky;
}

cv::Mat3b shade(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                const std::vector<Eigen::Vector3d>& points, const Raster& raster,
                const Eigen::Matrix3d& axes) {
  std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
  for (Eigen::Vector3d& n : normals) n = axes * n;
  cv::Mat3b picture(raster.triangle.size(), cv::Vec3b(kBackground[0], kBackground[1], kBackground[2]));
  // Every pixel is its own, so the number of threads changes nothing.
  picture.forEach([&](cv::Vec3b& pixel, const int* at) {
    const int y = at[0], x = at[1], index = raster.triangle(y, x);
    if (index < 0) return;
    const Eigen::Vector3i& t = mesh.triangles[index];
    const Eigen::Vector3d w =
        picture_barycentric({x + 0.5, y + 0.5}, points[t[0]], points[t[1]], points[t[2]]);
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(), rgb = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Colour& colour = colours.empty() ? kNeutral : colours[t[k]];
      normal += w[k] * normals[t[k]];
      rgb += w[k] * Eigen::Vector3d(colour[0], colour[1], colour[2]);
    }
    const double light = light_on(normal.normalized());
    for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(light * rgb[2 - c]);
  });
  return picture;
}

// Dots along the line, each where it is not behind the skin.
void draw_line(const Polyline& line, const Camera& camera, const Raster& raster, cv::Mat3b& picture) {
  const cv::Scalar colour(line.colour[2], line.colour[1], line.colour[0]);
  const int radius =
      line.width > 0 ? std::max(1, static_cast<int>(std::lround(line.width / 2 * camera.scale))) : 0;
  const std::size_t count = line.points.size(), segments = line.closed ? count : count - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::Vector3d a = camera(line.points[i]), b = camera(line.points[(i + 1) % count]);
    const double pixels = (b - a).head<2>().norm();
    if (!(pixels < 1e5)) continue;
    const int steps = 1 + static_cast<int>(2 * pixels);
    for (int s = 0; s <= steps; ++s) {
      const Eigen::Vector3d p = a + (b - a) * s / steps;
      const cv::Point at(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
      if (at.x < 0 || at.y < 0 || at.x >= picture.cols || at.y >= picture.rows) continue;
      if (p.z() - kLineLift <= raster.depth(at)) cv::circle(picture, at, radius, colour, cv::FILLED);
    }
  }
}

void check(const geometry::TriangleMesh& mesh, const View& view, int width, int height) {
  geometry::check_mesh(mesh);
  if (width < 1 || height < 1 || !(view.height > 0))
    throw geometry::Refusal(geometry::refusal::kBadOption, "picture: it has no size");
}

}  // namespace

View front_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height) {
  return view_along(body_from_scan, {-1, 0, 0}, centre, height);
}

View side_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height) {
  return view_along(body_from_scan, {0, -1, 0}, centre, height);
}

View oblique_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height) {
  return view_along(body_from_scan, {-1, -0.75, -0.3}, centre, height);
}

View back_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre, double height) {
  return view_along(body_from_scan, {1, 0, 0}, centre, height);
}

View oblique_back_view(const Eigen::Isometry3d& body_from_scan, const Eigen::Vector3d& centre,
                       double height) {
  return view_along(body_from_scan, {1, -0.75, -0.3}, centre, height);
}

View framed(MakeView make, const Eigen::Isometry3d& body_from_scan,
            const std::vector<Eigen::Vector3d>& points, double margin) {
  View view = make(body_from_scan, Eigen::Vector3d::Zero(), 1);
  const Eigen::Vector3d right = view.forward.cross(view.up);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kFar, kFar), high(-kFar, -kFar);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d seen(p.dot(right), p.dot(view.up));
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  if (points.empty()) return view;
  const Eigen::Vector2d middle = (low + high) / 2;
  view.centre = middle.x() * right + middle.y() * view.up;
  view.height = std::max(1e-3, margin * (high - low).maxCoeff());
  return view;
}

cv::Mat draw(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
             const std::vector<Polyline>& lines, const View& view, int width, int height) {
  check(mesh, view, width, height);
  if (!colours.empty() && colours.size() != mesh.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "picture: not one colour a vertex");

  const Camera camera(view, kOversampling * width, kOversampling * height);
  std::vector<Eigen::Vector3d> points(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), points.begin(), camera);
  const Raster raster = rasterise(points, mesh.triangles, kOversampling * width, kOversampling * height);
  cv::Mat3b picture = shade(mesh, colours, points, raster, camera.axes);
  for (const Polyline& line : lines)
    if (!line.points.empty()) draw_line(line, camera, raster, picture);
  cv::Mat result;
  cv::resize(picture, result, cv::Size(width, height), 0, 0, cv::INTER_AREA);
  return result;
}

cv::Mat1b silhouette(const geometry::TriangleMesh& mesh, const View& view, int width, int height) {
  check(mesh, view, width, height);
  const Camera camera(view, width, height);
  std::vector<Eigen::Vector3d> points(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), points.begin(), camera);
  return rasterise(points, mesh.triangles, width, height).triangle >= 0;
}

std::vector<SeenPoint> seen_points(const geometry::TriangleMesh& mesh,
                                   const std::vector<Eigen::Vector3d>& points, const View& view, int width,
                                   int height) {
  check(mesh, view, width, height);
  const Camera camera(view, width, height);
  std::vector<Eigen::Vector3d> corners(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), corners.begin(), camera);
  const Raster raster = rasterise(corners, mesh.triangles, width, height);
  std::vector<SeenPoint> seen;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = camera(point);
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    const bool inside = x >= 0 && y >= 0 && x < width && y < height && std::isfinite(raster.depth(y, x));
    seen.push_back({p.head<2>(), inside ? p.z() - raster.depth(y, x) : 0});
  }
  return seen;
}

}  // namespace tensegric_fit::inspect
