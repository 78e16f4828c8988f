#include "tffd/skin_near.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/even_steps.hpp"
#include "geometry/section.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::Refusal;
using geometry::SurfacePoint;
using geometry::refusal::kBadGarment;

constexpr double kLineReach = 0.15;  // m: skin farther from the line than this has no part in it
constexpr double kMarch = 0.0025;    // m, a step over the skin across the band
constexpr int kCoarsest = 4;         // shortest ways: so many times the spacing at first, then half of it
constexpr double kStill = 1e-6;      // m: a way none of whose points moves farther has settled
constexpr int kMostSweeps = 200;     // of few points, which settle in 20 to 150
constexpr int kFineSweeps = 20;      // of more, which begin on the way of the fewer (a cap: see shortest)

// One flag per vertex.
std::vector<char> are_near(const std::vector<Vector3d>& vertices, const std::vector<Vector3d>& line) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : line) box.extend(point);
  const geometry::PointTree tree(line);
  std::vector<char> close(vertices.size());
  for (std::size_t v = 0; v < close.size(); ++v)
    close[v] = box.exteriorDistance(vertices[v]) < kLineReach && tree.distance(vertices[v]) < kLineReach;
  return close;
}

// Triangles of which so many corners and more are close.
std::vector<Eigen::Vector3i> touching(const geometry::TriangleMesh& body, const std::vector<char>& close,
                                      int corners) {
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector3i& t : body.triangles)
    if (close[t[0]] + close[t[1]] + close[t[2]] >= corners) triangles.push_back(t);
  if (triangles.empty()) throw Refusal(kBadGarment, "lies nowhere near the body");
  return triangles;
}

}  // namespace

SkinNear::SkinNear(const geometry::TriangleMesh& body, const std::vector<Vector3d>& line)
    : SkinNear(body, are_near(body.vertices, line)) {}

SkinNear::SkinNear(const geometry::TriangleMesh& body, const std::vector<char>& close)
    : skin_{body.vertices, touching(body, close, 3)},
      normals_(geometry::vertex_normals(body.vertices, touching(body, close, 1))),
      tree_(skin_) {}

SurfacePoint SkinNear::below(const Vector3d& q) const {
  const SurfacePoint at = nearest(q);
  if ((at.position - q).norm() > kFarFromSkin)
    throw Refusal(kBadGarment,
                  fmt::format("runs more than 30 mm away from the skin at ({:.3f}, {:.3f}, {:.3f}) m: "
                              "between its points it goes straight",
                              q.x(), q.y(), q.z()));
  return at;
}

Vector3d SkinNear::normal(const SurfacePoint& at) const {
  const Eigen::Vector3i& k = corners(at);
  return (at.barycentric[0] * normals_[k[0]] + at.barycentric[1] * normals_[k[1]] +
          at.barycentric[2] * normals_[k[2]])
      .normalized();
}

SurfacePoint SkinNear::march(SurfacePoint from, const Vector3d& direction, double way) const {
  const int steps = static_cast<int>(std::ceil(std::abs(way) / kMarch));
  for (int i = 0; i < steps; ++i) {
    const Vector3d square = normal(from);
    const Vector3d level = direction - square.dot(direction) * square;
    from = nearest(from.position + way / steps * level.normalized());
  }
  return from;
}

// Each point goes half way between its neighbours, back onto the skin: a few points until they have settled,
// then more and more of them, which have only bends of their own spacing left to lose. Farther than half way
// would settle sooner, but throws points from side to side of a fold.
std::vector<SurfacePoint> SkinNear::shortest(std::vector<Vector3d> way) const {
  std::vector<SurfacePoint> points;
  for (int coarse = kCoarsest; coarse >= 1; coarse /= 2) {
    points.clear();
    for (const Vector3d& point : evenly(way, coarse * kLineSpacing)) points.push_back(nearest(point));
    const int sweeps = coarse == kCoarsest ? kMostSweeps : kFineSweeps;
    double moved = 1;
    for (int sweep = 0; sweep < sweeps && moved > kStill; ++sweep) {
      moved = 0;
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const SurfacePoint half_way = nearest((points[i - 1].position + points[i + 1].position) / 2);
        moved = std::max(moved, (half_way.position - points[i].position).norm());
        points[i] = half_way;
      }
    }
    way.clear();
    for (const SurfacePoint& point : points) way.push_back(point.position);
  }
  return points;
}

std::vector<Vector3d> evenly(const std::vector<Vector3d>& line, double spacing) {
  const double length = geometry::length_of(line, false);
  if (!(length > kLineSpacing)) throw Refusal(kBadGarment, "has no length on the body");
  if (length > kLongestLine)
    throw Refusal(kBadGarment, fmt::format("is {:g} m long, more than {:g}", length, kLongestLine));
  const int count = std::max(2, static_cast<int>(std::ceil(length / spacing)) + 1);
  std::vector<Vector3d> points = geometry::between_ends(line, count - 2);
  points.insert(points.begin(), line.front());
  points.push_back(line.back());
  return points;
}

}  // namespace tensegric_fit::tffd
