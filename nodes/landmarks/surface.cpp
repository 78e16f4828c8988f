#include "landmarks/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/even_steps.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;
using geometry::SectionLoop;

constexpr double kSlab = 0.02;           // m
constexpr double kHighest = 10;          // m, numerical tolerance: memory is taken by height
constexpr double kProfileSmoothing = 4;  // steps: deviation of the Gaussian that takes noise out of a profile
constexpr std::size_t kFewest = 8;       // points of a loop; less are slivers where an arm was cut off

std::vector<SectionLoop> without_slivers(std::vector<SectionLoop> loops) {
  loops.erase(std::remove_if(loops.begin(), loops.end(),
                             [](const SectionLoop& l) { return l.points.size() <= kFewest; }),
              loops.end());
  return loops;
}

double width_of(const SectionLoop& loop) {
  const auto box = geometry::bounding_box(loop.points);
  return (box[1] - box[0]).sum();
}

}  // namespace

std::vector<SectionLoop> cut(const Surface& surface, const Vector3d& origin, const Vector3d& normal,
                             const Selected& selected) {
  std::vector<double> height(surface.mesh.vertices.size());
  for (std::size_t v = 0; v < height.size(); ++v) height[v] = normal.dot(surface.mesh.vertices[v] - origin);
  std::vector<int> through;
  for (std::size_t i = 0; i < surface.mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = surface.mesh.triangles[i];
    const bool above = height[t[0]] >= 0;
    if (((height[t[1]] >= 0) != above || (height[t[2]] >= 0) != above) && selected(t))
      through.push_back(static_cast<int>(i));
  }
  std::vector<SectionLoop> loops =
      without_slivers(geometry::plane_section(geometry::submesh(surface.mesh, through), origin, normal));
  for (SectionLoop& loop : loops)
    for (int& triangle : loop.triangles) triangle = through[triangle];
  return loops;
}

Trunk::Trunk(Surface surface) : surface_(std::move(surface)) {
  const geometry::TriangleMesh& mesh = surface_.mesh;
  const auto box = geometry::bounding_box(mesh.vertices);
  bottom_ = box[0].z();
  if (!(box[1].z() - bottom_ < kHighest))
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the mesh is higher than 10 m");
  triangles_in_.resize(static_cast<std::size_t>((box[1].z() - bottom_) / kSlab) + 1);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    if (!(*this)(t)) continue;
    double low = box[1].z(), high = bottom_;
    for (int k = 0; k < 3; ++k) {
      low = std::min(low, mesh.vertices[t[k]].z());
      high = std::max(high, mesh.vertices[t[k]].z());
    }
    for (auto s = static_cast<std::size_t>((low - bottom_) / kSlab);
         s <= static_cast<std::size_t>((high - bottom_) / kSlab); ++s)
      triangles_in_[s].push_back(static_cast<int>(i));
  }
}

bool Trunk::operator()(const Eigen::Vector3i& t) const {
  return !surface_.is_arm(t);
}

std::vector<SectionLoop> Trunk::level(double height) const {
  const double slab = (height - bottom_) / kSlab;
  if (!(slab >= 0 && slab < static_cast<double>(triangles_in_.size()))) return {};
  return without_slivers(
      geometry::plane_section(geometry::submesh(surface_.mesh, triangles_in_[static_cast<std::size_t>(slab)]),
                              {0, 0, height}, Vector3d::UnitZ()));
}

std::vector<Vector3d> Trunk::tape(double height) const {
  std::vector<Vector3d> points;
  for (const SectionLoop& loop : level(height))
    points.insert(points.end(), loop.points.begin(), loop.points.end());
  return points.size() < 3 ? std::vector<Vector3d>() : geometry::tape(points, Vector3d::UnitZ());
}

std::vector<Vector3d> Trunk::tape_of_torso(double height) const {
  const std::vector<SectionLoop> loops = level(height);
  if (loops.empty()) return {};
  const auto widest = std::max_element(
      loops.begin(), loops.end(), [](const auto& a, const auto& b) { return width_of(a) < width_of(b); });
  return geometry::tape(widest->points, Vector3d::UnitZ());
}

Profile profile_down(const Trunk& trunk, const Vector3d& start, double length) {
  std::vector<Vector3d> line;
  double nearest = 0.05;  // m; farther from the start there is no profile of it
  for (const SectionLoop& loop : cut(trunk.surface(), start, Vector3d::UnitY(), trunk)) {
    const auto place =
        std::min_element(loop.points.begin(), loop.points.end(), [&](const Vector3d& a, const Vector3d& b) {
          return (a - start).squaredNorm() < (b - start).squaredNorm();
        });
    if ((*place - start).norm() >= nearest) continue;
    nearest = (*place - start).norm();
    // Both ways from there; down is the one that is lower after some centimetres.
    std::vector<Vector3d> ahead(place, loop.points.end()),
        back(std::make_reverse_iterator(place + 1), loop.points.rend());
    if (loop.closed) {
      ahead.insert(ahead.end(), loop.points.begin(), place);
      back.insert(back.end(), loop.points.rbegin(), std::make_reverse_iterator(place + 1));
    }
    const auto low = [](const std::vector<Vector3d>& way) {
      double gone = 0, sum = 0, weight = 0;
      for (std::size_t i = 1; i < way.size() && gone < 0.12; ++i) {
        const double step = (way[i] - way[i - 1]).norm();
        gone += step;
        sum += step * way[i].z();
        weight += step;
      }
      return weight > 0 ? sum / weight : 1e9;
    };
    line = low(ahead) < low(back) ? ahead : back;
  }
  Profile profile;
  if (line.size() < 3) return profile;
  profile.points = geometry::smoothed(geometry::even_steps(line, Profile::kStep, length), kProfileSmoothing,
                                      static_cast<int>(3 * kProfileSmoothing));
  const int last = static_cast<int>(profile.points.size()) - 1;
  profile.curvature.assign(profile.points.size(), 0);
  for (int i = 1; i < last; ++i) {
    const Vector3d a = profile.points[i] - profile.points[i - 1],
                   b = profile.points[i + 1] - profile.points[i];
    // Down the front of a body, seen from her left: skin that turns outwards turns about +y.
    const double turn = std::atan2(a.cross(b).y(), a.dot(b));
    profile.curvature[i] = -turn / ((a.norm() + b.norm()) / 2);
  }
  return profile;
}

double unseen_share(const Surface& surface, const Vector3d& point, double radius) {
  if (surface.unseen.empty()) return 0;
  double all = 0, unseen = 0, least = 1e9;
  std::size_t nearest = 0;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    const double squared = (surface.mesh.vertices[v] - point).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = v;
    }
    if (squared > radius * radius) continue;
    ++all;
    unseen += surface.unseen[v];
  }
  return all > 0 ? unseen / all : static_cast<double>(surface.unseen[nearest]);
}

std::vector<int> vertices_near(const Surface& surface, const Vector3d& point, double radius,
                               const std::function<bool(int)>& wanted) {
  std::vector<int> near;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v)
    if ((surface.mesh.vertices[v] - point).squaredNorm() < radius * radius && wanted(static_cast<int>(v)))
      near.push_back(static_cast<int>(v));
  return near;
}

}  // namespace tensegric_fit::landmarks
