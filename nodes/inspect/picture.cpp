#include "inspect/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "geometry/parallel_for.hpp"
#include "geometry/shading_normals.hpp"
#include "geometry/status.hpp"
#include "inspect/raster.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr int kOversampling = 2;  // along each axis
constexpr double kLineLift =
    0.012;  // metres; between control nodes a line runs under the skin, but less than this
constexpr std::uint8_t kBackground = 255;  // of each colour

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
float light_on(Eigen::Vector3f n) {
  static const Eigen::Vector3f to_lamp = Eigen::Vector3f(0, -0.55F, -1).normalized();
  if (n.z() > 0) n = -n;  // both sides of the skin are lit alike
  const float lamp = std::max(0.0F, n.dot(to_lamp)), sky = (1 - n.y()) / 2;
  return 0.30F + 0.56F * lamp + 0.26F * sky;
}

// Single numbers: a picture has 256 steps. \pre kOversampling 2
cv::Mat3b shade(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                const std::vector<Eigen::Vector3d>& smooth, const std::vector<Eigen::Vector3d>& points,
                const Raster& raster, const Eigen::Matrix3d& axes) {
  std::vector<Eigen::Vector3f> normals(smooth.size());
  for (std::size_t v = 0; v < smooth.size(); ++v) normals[v] = (axes * smooth[v]).cast<float>();
  const auto rgb_of = [&](int vertex) {
    const Colour& colour = colours[vertex];
    return Eigen::Vector3f(colour[0], colour[1], colour[2]);
  };
  const Eigen::Vector3f neutral(kNeutral[0], kNeutral[1], kNeutral[2]);
  cv::Mat3b picture(raster.triangle.size());
  std::fill_n(picture.ptr(), picture.total() * picture.elemSize(), kBackground);
  const auto at = [&](int index, double x, double y) -> cv::Vec3b {
    const Eigen::Vector3i& t = mesh.triangles[index];
    const Eigen::Vector3f w =
        picture_barycentric({x, y}, points[t[0]], points[t[1]], points[t[2]]).cast<float>();
    const Eigen::Vector3f normal = w[0] * normals[t[0]] + w[1] * normals[t[1]] + w[2] * normals[t[2]];
    const Eigen::Vector3f rgb =
        colours.empty() ? neutral
                        : Eigen::Vector3f(w[0] * rgb_of(t[0]) + w[1] * rgb_of(t[1]) + w[2] * rgb_of(t[2]));
    const float light = light_on(normal.normalized());
    return {cv::saturate_cast<std::uint8_t>(light * rgb[2]), cv::saturate_cast<std::uint8_t>(light * rgb[1]),
            cv::saturate_cast<std::uint8_t>(light * rgb[0])};
  };
  // Four pixels at a time: where one triangle has them all, they have one colour. Each four are their own.
  geometry::parallel_for(picture.rows / 2, [&](std::size_t begin, std::size_t end, int) {
    for (int y = 2 * static_cast<int>(begin); y < 2 * static_cast<int>(end); y += 2)
      for (int x = 0; x < picture.cols; x += 2) {
        const int first = raster.triangle(y, x);
        const bool one = first == raster.triangle(y, x + 1) && first == raster.triangle(y + 1, x) &&
                         first == raster.triangle(y + 1, x + 1);
        if (one && first < 0) continue;
        const cv::Vec3b colour = one ? at(first, x + 1, y + 1) : cv::Vec3b();
        for (int k = 0; k < 4; ++k) {
          const int row = y + k / 2, column = x + k % 2, index = raster.triangle(row, column);
          if (index >= 0) picture(row, column) = one ? colour : at(index, column + 0.5, row + 0.5);
        }
      }
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
      if (!(p.x() >= 0 && p.y() >= 0 && p.x() < picture.cols && p.y() < picture.rows)) continue;
      const cv::Point at(static_cast<int>(p.x()), static_cast<int>(p.y()));
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
             const std::vector<Polyline>& lines, const View& view, int width, int height,
             const std::vector<Eigen::Vector3d>& normals) {
  check(mesh, view, width, height);
  for (const std::size_t count : {colours.size(), normals.size()})
    if (count != 0 && count != mesh.vertices.size())
      throw geometry::Refusal(geometry::refusal::kBadMesh, "picture: not one colour or normal a vertex");

  const Camera camera(view, kOversampling * width, kOversampling * height);
  std::vector<Eigen::Vector3d> points(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), points.begin(), camera);
  const Raster raster = rasterise(points, mesh.triangles, kOversampling * width, kOversampling * height);
  cv::Mat3b picture = shade(
      mesh, colours, normals.empty() ? geometry::shading_normals(mesh.vertices, mesh.triangles) : normals,
      points, raster, camera.axes);
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
