#include "surface_distance.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/surface_tree.hpp"

namespace tensegric_fit::gauge {
namespace {

constexpr std::size_t kSampled = 4000;

// Some thousand of `count`, evenly, without those left out.
std::vector<std::size_t> sampled(std::size_t count, const std::vector<char>& left_out) {
  const std::size_t step = std::max<std::size_t>(1, count / kSampled);
  std::vector<std::size_t> picked;
  for (std::size_t i = 0; i < count; i += step)
    if (left_out.empty() || !left_out[i]) picked.push_back(i);
  return picked;
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<long>(place), values.end());
  return values[place];
}

std::vector<double> distances(const std::vector<Eigen::Vector3d>& points, const std::vector<char>& left_out,
                              const geometry::TriangleMesh& surface) {
  const geometry::SurfaceTree tree(surface);
  std::vector<double> all;
  for (const std::size_t i : sampled(points.size(), left_out))
    all.push_back((tree.nearest(points[i]).position - points[i]).norm());
  return all;
}

std::vector<double> normal_angles(const geometry::TriangleMesh& mesh, const std::vector<char>& left_out,
                                  const geometry::TriangleMesh& surface) {
  const geometry::SurfaceTree tree(surface);
  const std::vector<Eigen::Vector3d> ours = geometry::vertex_normals(mesh.vertices, mesh.triangles),
                                     theirs = geometry::vertex_normals(surface.vertices, surface.triangles);
  std::vector<double> all;
  for (const std::size_t i : sampled(mesh.vertices.size(), left_out)) {
    const geometry::SurfacePoint foot = tree.nearest(mesh.vertices[i]);
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) normal += foot.barycentric[k] * theirs[surface.triangles[foot.triangle][k]];
    all.push_back(std::atan2(ours[i].cross(normal).norm(), ours[i].dot(normal)) * 180 / M_PI);
  }
  return all;
}

}  // namespace tensegric_fit::gauge
