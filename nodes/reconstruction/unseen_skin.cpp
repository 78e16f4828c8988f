#include "reconstruction/unseen_skin.hpp"

#include <algorithm>

#include "body_model/oriented_tree.hpp"
#include "body_model/samples.hpp"
#include "geometry/point_tree.hpp"

namespace tensegric_fit::reconstruction {
namespace {

constexpr double kUnseen = 0.008;    // m from every point that faces the same way: sparse scans leave 5 between two
constexpr double kReach = 0.02;      // m that a normal turned by 60 degrees counts like: the other wall of a pocket is no neighbour
constexpr double kBeyond = 0.10;     // m; skin that far from every point is a part that was not scanned, and is not made up
constexpr double kSpacing = 0.004;   // m
constexpr double kInside = 0.03;     // m under other skin that faces the other way: parts that touch
constexpr int kAround = 100;         // samples within that

}  // namespace

geometry::PointCloud unseen_skin(const body_model::RegisteredBody& body, const geometry::PointCloud& seen) {
  const body_model::Model& model = *body.model;
  geometry::TriangleMesh skin{body.skin, {}};
  double area = 0;
  for (const Eigen::Vector3i& t : model.triangles) {
    const std::string& part = model.parts[model.part[t[0]]];
    if (part.rfind("hand", 0) == 0) continue;
    skin.triangles.push_back(t);
    area += geometry::area_vector(body.skin[t[0]], body.skin[t[1]], body.skin[t[2]]).norm() / 2;
  }
  const body_model::Samples samples = body_model::sample_surface(skin, {}, static_cast<int>(area / (kSpacing * kSpacing)));
  const geometry::PointTree own(samples.points), tree(seen.points);
  const body_model::OrientedTree oriented(seen.points, seen.normals, kReach);
  geometry::PointCloud unseen;
  std::vector<int> near;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Eigen::Vector3d &p = samples.points[i], &n = samples.normals[i];
    if (oriented.distance(p, n) < kUnseen || tree.distance(p) > kBeyond) continue;
    // What lies under skin that faces the other way has run into it.
    own.nearest(p, kAround, near);
    const bool inside = std::any_of(near.begin(), near.end(), [&](int j) {
      return n.dot(samples.normals[j]) < -0.3 && samples.normals[j].dot(p - samples.points[j]) < 0 && (p - samples.points[j]).norm() < kInside;
    });
    if (inside) continue;
    unseen.points.push_back(p);
    unseen.normals.push_back(n);
  }
  return unseen;
}

}  // namespace tensegric_fit::reconstruction
