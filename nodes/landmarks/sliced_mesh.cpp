#include "landmarks/sliced_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::landmarks {
namespace {

constexpr int kSlabs = 100;  // of some 600 triangles each on a body of 62,000

}  // namespace

SlicedMesh::SlicedMesh(const geometry::TriangleMesh& mesh) : slabs_(kSlabs) {
  const auto box = geometry::bounding_box(mesh.vertices);
  bottom_ = box[0].z();
  top_ = box[1].z();
  std::vector<std::vector<int>> reaching(kSlabs);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = mesh.triangles[t];
    const double a = mesh.vertices[v[0]].z(), b = mesh.vertices[v[1]].z(), c = mesh.vertices[v[2]].z();
    for (int s = slab_of(std::min({a, b, c})); s <= slab_of(std::max({a, b, c})); ++s)
      reaching[s].push_back(static_cast<int>(t));
  }
  std::vector<int> index(mesh.vertices.size(), -1);
  for (int s = 0; s < kSlabs; ++s) {
    geometry::TriangleMesh& slab = slabs_[s];
    std::vector<int> taken;
    for (int t : reaching[s]) {
      Eigen::Vector3i corners;
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.triangles[t][k];
        if (index[v] < 0) {
          index[v] = static_cast<int>(slab.vertices.size());
          slab.vertices.push_back(mesh.vertices[v]);
          taken.push_back(v);
        }
        corners[k] = index[v];
      }
      slab.triangles.push_back(corners);
    }
    for (int v : taken) index[v] = -1;
  }
}

std::vector<Outline> SlicedMesh::outlines_at(double height) const {
  if (height <= bottom_ || height >= top_) return {};
  return outlines_of(
      geometry::plane_section(slabs_[slab_of(height)], {0, 0, height}, Eigen::Vector3d::UnitZ()));
}

int SlicedMesh::slab_of(double height) const {
  const double share = (height - bottom_) / std::max(top_ - bottom_, 1e-9);
  return std::clamp(static_cast<int>(share * kSlabs), 0, kSlabs - 1);
}

}  // namespace tensegric_fit::landmarks
