#include "tffd/under_constriction.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/section.hpp"
#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::FitWarning;

constexpr double kStep = 0.01;       // m, along a line
constexpr double kMostSteps = 1000;  // between two points of a line: no body is larger
constexpr double kAround = 0.05;     // m, of skin about a line that is looked at
constexpr double kShorter = 1e-3;    // of the neutral length
constexpr double kNoTension = 1e-6;  // pseudo force: below what solvers settle to

std::vector<Vector3d> stepped(const std::vector<Vector3d>& course) {
  std::vector<Vector3d> points;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const Vector3d way = course[i] - course[i - 1];
    const int steps = static_cast<int>(std::clamp(std::ceil(way.norm() / kStep), 1.0, kMostSteps));
    for (int k = 0; k < steps; ++k) points.push_back(course[i - 1] + (k + 0.5) / steps * way);
  }
  return points;
}

// The triangles about a course.
std::vector<int> triangles_about(const std::vector<Vector3d>& course, const WornSkin& skin,
                                 const std::vector<Vector3d>& vertices) {
  auto [low, high] = geometry::bounding_box(course);
  low.array() -= kAround;
  high.array() += kAround;
  std::vector<int> triangles;
  for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
    const Eigen::Vector3i& t = skin.triangles[i];
    const Vector3d& corner = vertices[t[0]];
    if ((corner.array() < low.array()).any() || (corner.array() > high.array()).any()) continue;
    if (geometry::distance_to_line(corner, course) < kAround) triangles.push_back(static_cast<int>(i));
  }
  return triangles;
}

// A course over skin: where its points are above it, and how high. m.
struct Lie {
  std::vector<Vector3d> points, feet;
  std::vector<double> heights;
  std::vector<int> triangles;

  bool off(std::size_t i) const { return heights[i] > kOffSkin; }
  double share_off() const {
    double count = 0;
    for (std::size_t i = 0; i < heights.size(); ++i) count += off(i) ? 1 : 0;
    return heights.empty() ? 0 : count / static_cast<double>(heights.size());
  }
};

Lie lie_of(const std::vector<Vector3d>& course, const WornSkin& skin, const std::vector<Vector3d>& vertices) {
  Lie lie;
  if (course.empty()) return lie;
  lie.triangles = triangles_about(course, skin, vertices);
  if (lie.triangles.empty()) return lie;
  geometry::TriangleMesh about{{}, {}};
  for (const int t : lie.triangles) {
    const int first = static_cast<int>(about.vertices.size());
    for (const int v : skin.triangles[t]) about.vertices.push_back(vertices[v]);
    about.triangles.emplace_back(first, first + 1, first + 2);
  }
  const geometry::SurfaceTree tree(about);
  lie.points = stepped(course);
  for (const Vector3d& point : lie.points) {
    const geometry::SurfacePoint foot = tree.nearest(point);
    const Eigen::Vector3i& t = about.triangles[foot.triangle];
    const Vector3d normal =
        geometry::area_vector(about.vertices[t[0]], about.vertices[t[1]], about.vertices[t[2]]).normalized();
    lie.feet.push_back(foot.position);
    const Vector3d way = point - foot.position;
    lie.heights.push_back(way.norm() > kAround ? kAround : normal.dot(way));
  }
  return lie;
}

void take_skin(const Lie& lie, const WornSkin& skin, FitWarning& warning) {
  const bool parts = warning.lack == geometry::lack::kLiftsOff;
  std::vector<Vector3d> feet;
  for (std::size_t i = 0; i < lie.feet.size(); ++i)
    if (!parts || lie.off(i)) feet.push_back(lie.feet[i]);
  std::vector<int> triangles;
  for (const int i : lie.triangles) {
    const Eigen::Vector3i& t = skin.triangles[i];
    const Vector3d middle = (skin.worn[t[0]] + skin.worn[t[1]] + skin.worn[t[2]]) / 3;
    if (std::any_of(feet.begin(), feet.end(), [&](const Vector3d& foot) {
          return (foot - middle).squaredNorm() < kHeldSkin * kHeldSkin;
        }))
      triangles.push_back(i);
  }
  take_place(triangles, skin, warning);
}

}  // namespace

std::vector<FitWarning> under_constricted(const WornSkin& skin, const std::vector<WornLine>& lines,
                                          const HoldOptions& options) {
  if (skin.worn.size() != skin.rest.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "skin check: not one worn place a vertex");
  std::vector<FitWarning> all;
  for (const WornLine& line : lines) {
    FitWarning warning;
    warning.code = geometry::notice::kUnderConstricted;
    warning.line = line.name;
    warning.value = line.tension;
    const Lie worn = lie_of(line.worn, skin, skin.worn);
    if (line.tension <= kNoTension || line.final < (1 - kShorter) * line.neutral) {
      warning.lack = geometry::lack::kSlack;
    } else if (line.tension < options.least_pull) {
      warning.lack = geometry::lack::kWeak;
    } else if (worn.share_off() > kLiftedShare) {
      const double lifted = worn.share_off() - lie_of(line.at_rest, skin, skin.rest).share_off();
      if (lifted <= kLiftedShare) continue;
      warning.lack = geometry::lack::kLiftsOff;
      warning.value = lifted;
    } else {
      continue;
    }
    take_skin(worn, skin, warning);
    all.push_back(std::move(warning));
  }
  return all;
}

std::vector<int> under_constricted_skin(const std::vector<FitWarning>& warnings) {
  std::vector<int> vertices;
  for (const FitWarning& warning : warnings)
    if (warning.code == geometry::notice::kUnderConstricted)
      vertices.insert(vertices.end(), warning.vertices.begin(), warning.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace tensegric_fit::tffd
