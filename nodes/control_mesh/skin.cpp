#include "control_mesh/skin.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/even_steps.hpp"
#include "geometry/section.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr double kCell = 0.02;                     // m; a few body triangles (about 7 mm) a cell
constexpr int kLeastCells = 20, kMostCells = 200;  // along the longest axis, whatever the mesh's size
// Cells of the grid, and triangles in cells, at most; bodies have fewer. Else cells are wider.
constexpr double kLeastRoom = 1 << 18, kRoomPerTriangle = 8, kWider = 1.25;
constexpr double kOnEdge = 1e-9;  // barycentric: a ray in the plane of symmetry runs exactly along edges
constexpr double kOnLoop = 1e-6;  // m; a point of the skin lies on a section through it
constexpr double kAside = 0.06;   // m; how far the way between two nodes swings out of their box
constexpr double kFar = std::numeric_limits<double>::infinity();

struct Hit {
  double distance;  // along the ray
  bool leaving;     // from inside to outside
};

std::optional<Hit> hit(const Vector3d& from, const Vector3d& direction, const Vector3d& a, const Vector3d& b,
                       const Vector3d& c) {
  const Vector3d u = b - a, v = c - a, across = direction.cross(v);
  const double determinant = u.dot(across);
  if (std::abs(determinant) < 1e-15) return std::nullopt;  // seen edge-on: its neighbours are hit
  const Vector3d w = from - a, along = w.cross(u);
  const double s = w.dot(across) / determinant, t = direction.dot(along) / determinant;
  if (s < -kOnEdge || t < -kOnEdge || s + t > 1 + kOnEdge) return std::nullopt;
  return Hit{v.dot(along) / determinant, determinant < 0};
}

Vector3d nearest_on_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double squared = (b - a).squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(b - a) / squared, 0.0, 1.0) : 0.0;
  return a + t * (b - a);
}

struct PlaceOnLoop {
  std::size_t segment = 0;
  Vector3d point;
  double distance = kFar;
};

PlaceOnLoop place_on(const geometry::SectionLoop& loop, const Vector3d& p) {
  PlaceOnLoop best;
  const std::size_t count = loop.points.size(), segments = loop.closed ? count : count - 1;
  for (std::size_t s = 0; s < segments; ++s) {
    const Vector3d q = nearest_on_segment(p, loop.points[s], loop.points[(s + 1) % count]);
    if ((q - p).norm() < best.distance) best = {s, q, (q - p).norm()};
  }
  return best;
}

/// The loop's points from `a` forward to `b`; empty where an open loop does not lead there.
std::vector<Vector3d> forward(const geometry::SectionLoop& loop, const PlaceOnLoop& a, const PlaceOnLoop& b) {
  const std::size_t count = loop.points.size();
  std::vector<Vector3d> way{a.point};
  const bool ahead = b.segment > a.segment ||
                     (b.segment == a.segment &&
                      (b.point - loop.points[a.segment]).norm() >= (a.point - loop.points[a.segment]).norm());
  if (!ahead && !loop.closed) return {};
  const std::size_t steps = ahead ? b.segment - a.segment : count - a.segment + b.segment;
  for (std::size_t i = 1; i <= steps; ++i) way.push_back(loop.points[(a.segment + i) % count]);
  way.push_back(b.point);
  return way;
}

}  // namespace

Skin::Skin(geometry::TriangleMesh surface)
    : surface_(std::move(surface)),
      normals_(geometry::vertex_normals(surface_.vertices, surface_.triangles)),
      tree_(surface_) {
  // Of its triangles alone: a vertex of none may lie anywhere.
  Vector3d low = Vector3d::Constant(kFar), high = -low;
  for (const Eigen::Vector3i& k : surface_.triangles)
    for (int i = 0; i < 3; ++i) {
      low = low.cwiseMin(surface_.vertices[k[i]]);
      high = high.cwiseMax(surface_.vertices[k[i]]);
    }
  corner_ = low;
  const double size = (high - low).maxCoeff();
  if (!(size > 0)) throw geometry::Refusal(geometry::refusal::kBadMesh, "the surface has no extent");
  cell_ = std::clamp(kCell, size / kMostCells, size / kLeastCells);
  const auto divide = [&] { cells_ = ((high - low) / cell_).array().floor().cast<int>() + 1; };
  for (divide(); !has_room(); divide()) cell_ *= kWider;

  // Twice over all triangles and the cells that they touch: first to count, then to fill.
  const auto for_all = [&](const auto& visit) {
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const auto [first, last] = cells_of(surface_.triangles[t]);
      for (int z = first.z(); z <= last.z(); ++z)
        for (int y = first.y(); y <= last.y(); ++y)
          for (int x = first.x(); x <= last.x(); ++x) visit(static_cast<int>(t), number(x, y, z));
    }
  };
  starts_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
  for_all([&](int, int cell) { ++starts_[cell + 1]; });
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  entries_.resize(static_cast<std::size_t>(starts_.back()));
  std::vector<int> filled(starts_.begin(), starts_.end() - 1);
  for_all([&](int t, int cell) { entries_[filled[cell]++] = t; });
}

bool Skin::has_room() const {
  const double room = std::max(kLeastRoom, kRoomPerTriangle * static_cast<double>(surface_.triangles.size()));
  if (cells_.cast<double>().prod() > room) return false;
  double entries = 0;
  for (std::size_t t = 0; t < surface_.triangles.size() && entries <= room; ++t) {
    const auto [first, last] = cells_of(surface_.triangles[t]);
    entries += ((last - first).array() + 1).cast<double>().prod();
  }
  return entries <= room;
}

std::array<Eigen::Vector3i, 2> Skin::cells_of(const Eigen::Vector3i& triangle) const {
  const Vector3d &a = surface_.vertices[triangle[0]], &b = surface_.vertices[triangle[1]],
                 &c = surface_.vertices[triangle[2]];
  return {cell_of(a.cwiseMin(b).cwiseMin(c)), cell_of(a.cwiseMax(b).cwiseMax(c))};
}

Eigen::Vector3i Skin::cell_of(const Vector3d& point) const {
  const Vector3d cell = ((point - corner_) / cell_).array().floor();
  return cell.cwiseMax(0).cwiseMin((cells_.array() - 1).matrix().cast<double>()).cast<int>();
}

std::vector<int> Skin::triangles_near(const Vector3d& low, const Vector3d& high) const {
  const Eigen::Vector3i first = cell_of(low.array() - kOnEdge), last = cell_of(high.array() + kOnEdge);
  std::vector<int> found;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const int cell = number(x, y, z);
        found.insert(found.end(), entries_.begin() + starts_[cell], entries_.begin() + starts_[cell + 1]);
      }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::optional<Vector3d> Skin::first_exit(const Vector3d& from, const Vector3d& direction,
                                         double reach) const {
  const Vector3d to = from + reach * direction;
  double best = kFar;
  for (int t : triangles_near(from.cwiseMin(to), from.cwiseMax(to))) {
    const Eigen::Vector3i& k = surface_.triangles[t];
    const auto h =
        hit(from, direction, surface_.vertices[k[0]], surface_.vertices[k[1]], surface_.vertices[k[2]]);
    if (h && h->leaving && h->distance >= 0 && h->distance <= reach) best = std::min(best, h->distance);
  }
  if (best == kFar) return std::nullopt;
  return from + best * direction;
}

std::optional<Vector3d> Skin::nearest_along(const Vector3d& from, const Vector3d& direction,
                                            double reach) const {
  const Vector3d back = from - reach * direction, front = from + reach * direction;
  double best = kFar;
  for (int t : triangles_near(back.cwiseMin(front), back.cwiseMax(front))) {
    const Eigen::Vector3i& k = surface_.triangles[t];
    const auto h =
        hit(from, direction, surface_.vertices[k[0]], surface_.vertices[k[1]], surface_.vertices[k[2]]);
    if (h && h->leaving && std::abs(h->distance) <= reach && std::abs(h->distance) < std::abs(best))
      best = h->distance;
  }
  if (best == kFar) return std::nullopt;
  return from + best * direction;
}

Vector3d Skin::nearest(const Vector3d& point) const {
  return tree_.nearest(point).position;
}

Vector3d Skin::normal_near(const Vector3d& point) const {
  const geometry::SurfacePoint foot = tree_.nearest(point);
  const Eigen::Vector3i& k = surface_.triangles[foot.triangle];
  Vector3d normal = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) normal += foot.barycentric[i] * normals_[k[i]];
  return normal.stableNormalized();
}

std::vector<Vector3d> Skin::between(const Vector3d& a, const Vector3d& b, int count,
                                    const Vector3d& across) const {
  const Vector3d way_straight = (b - a).stableNormalized(),
                 normal = across - across.dot(way_straight) * way_straight;
  std::vector<Vector3d> way;
  if (normal.norm() > 0) {
    const geometry::TriangleMesh part = geometry::submesh(
        surface_, triangles_near(a.cwiseMin(b).array() - kAside, a.cwiseMax(b).array() + kAside));
    for (const geometry::SectionLoop& loop : geometry::plane_section(part, a, normal.normalized())) {
      const PlaceOnLoop at_a = place_on(loop, a), at_b = place_on(loop, b);
      if (at_a.distance > kOnLoop || at_b.distance > kOnLoop) continue;
      std::vector<Vector3d> there = forward(loop, at_a, at_b), back = forward(loop, at_b, at_a);
      std::reverse(back.begin(), back.end());
      for (auto& candidate : {there, back})
        if (!candidate.empty() &&
            (way.empty() || geometry::length_of(candidate, false) < geometry::length_of(way, false)))
          way = candidate;
    }
  }
  std::vector<Vector3d> points =
      geometry::between_ends(way.empty() ? std::vector<Vector3d>{a, b} : way, count);
  if (way.empty())  // the section is broken here: the skin beside the straight way
    for (Vector3d& p : points) p = nearest(p);
  return points;
}

}  // namespace tensegric_fit::control_mesh
