#include "correlation/skin_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "correlation/border.hpp"
#include "correlation/find_measure.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/status.hpp"
#include "geometry/surface_tree.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Vector3d;
using geometry::TriangleMesh;

constexpr double kLowestThigh = 6.0 / 7;                     // of the crotch's height
constexpr double kKnee = 0.60, kCalf = 0.53, kAnkle = 0.12;  // the same

std::vector<char> covered_by(const TriangleMesh& control, const TriangleMesh& body,
                             const std::vector<Vector3d>& normals) {
  const geometry::SurfaceTree tree(control);
  const Border border(control);
  std::vector<char> covered(body.vertices.size(), 0);
  for (std::size_t v = 0; v < covered.size(); ++v) {
    const geometry::SurfacePoint place = tree.nearest(body.vertices[v]);
    if ((place.position - body.vertices[v]).norm() > kUnderControl || border.holds(place)) continue;
    const Eigen::Vector3i& t = control.triangles[place.triangle];
    const Vector3d facing =
        geometry::area_vector(control.vertices[t[0]], control.vertices[t[1]], control.vertices[t[2]])
            .normalized();
    covered[v] = facing.dot(normals[v]) > kAlike;
  }
  return covered;
}

// The box of the trunk in the body frame.
struct Trunk {
  explicit Trunk(const geometry::BodyMeasures& measures) {
    const auto place = [&](const char* name) {
      return Vector3d(measures.body_from_scan * measures.landmark(name));
    };
    left = place("axilla_L").y();
    right = place("axilla_R").y();
    low = kLowestThigh * measures.height("crotch");
    high = std::max(place("shoulder_L").z(), place("shoulder_R").z());
  }
  bool holds(const Vector3d& p) const { return p.y() < left && p.y() > right && p.z() > low && p.z() < high; }
  double left, right, low, high;
};

// NaN where it was not found: no skin lies above it, and none below.
double level_in(const geometry::BodyMeasures& measures, const char* name) {
  const geometry::Measure* level = find_measure(measures.heights, name);
  return level == nullptr ? std::numeric_limits<double>::quiet_NaN() : level->metres;
}

}  // namespace

void check(const SimulatedBody& body) {
  geometry::check_mesh(body.rest);
  geometry::check_mesh(body.control);
  if (body.rest.triangles.empty() || body.control.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the simulated body or its control mesh is empty");
  if (body.deformed.size() != body.rest.vertices.size())
    throw geometry::Refusal(
        geometry::refusal::kBadMesh,
        fmt::format("the body has {} vertices and the deformed body {}: they are not of one fit",
                    body.rest.vertices.size(), body.deformed.size()));
  if (!std::all_of(body.deformed.begin(), body.deformed.end(), [](const auto& p) { return p.allFinite(); }))
    throw geometry::Refusal(geometry::refusal::kNonFinite, "the deformed body is not finite everywhere");
  if (!body.filled.empty() && body.filled.size() != body.rest.vertices.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh,
                            "filled holes of the body before need one flag per vertex");
}

std::vector<SkinPart> parts_of(const SimulatedBody& body) {
  const std::vector<Vector3d>& vertices = body.rest.vertices;
  const std::vector<char> covered =
      covered_by(body.control, body.rest, geometry::vertex_normals(vertices, body.rest.triangles));
  std::vector<Vector3d> worn;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (covered[v] != 0) worn.push_back(vertices[v]);
  if (worn.empty())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the control mesh covers no skin of the body");

  const geometry::PointTree near(worn);
  const Trunk trunk(body.measures);
  std::vector<SkinPart> parts(vertices.size(), SkinPart::mobile);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (covered[v] != 0)
      parts[v] = SkinPart::covered;
    else if (!trunk.holds(body.measures.body_from_scan * vertices[v]))
      continue;
    else if (near.distance(vertices[v]) < kSurroundings)
      parts[v] = SkinPart::surroundings;
    else if (body.is_seen(v))
      parts[v] = SkinPart::still;
  }
  return parts;
}

Pieces pieces_of(const SimulatedBody& body, const std::vector<SkinPart>& parts) {
  const geometry::BodyMeasures& measures = body.measures;
  const Trunk trunk(measures);
  const double crotch = measures.height("crotch"), underbust = level_in(measures, "underbust"),
               hip = level_in(measures, "hip");
  Pieces pieces;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    if (parts[v] == SkinPart::covered || parts[v] == SkinPart::surroundings || !body.is_seen(v)) continue;
    const Vector3d p = measures.body_from_scan * body.rest.vertices[v];
    const int vertex = static_cast<int>(v);
    const bool inwards = p.y() < trunk.left && p.y() > trunk.right;
    if (parts[v] == SkinPart::still && p.z() > underbust) pieces.chest.push_back(vertex);
    if (inwards && p.z() < hip && p.z() > kKnee * crotch) pieces.pelvis.push_back(vertex);
    if (p.z() < kCalf * crotch && p.z() > kAnkle * crotch)
      (p.y() > 0 ? pieces.left_shank : pieces.right_shank).push_back(vertex);
  }
  return pieces;
}

}  // namespace tensegric_fit::correlation
