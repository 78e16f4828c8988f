#include "correlation/border.hpp"

#include <algorithm>

namespace tensegric_fit::correlation {

Border::Border(const geometry::TriangleMesh& mesh) : mesh_(mesh), vertex_(mesh.vertices.size(), 0) {
  for (const geometry::Edge& edge : geometry::edges_of(mesh)) {
    if (edge.right >= 0) continue;
    edges_.push_back({edge.first, edge.second});
    vertex_[edge.first] = vertex_[edge.second] = 1;
  }
}

bool Border::holds(const geometry::SurfacePoint& place) const {
  const Eigen::Vector3i& t = mesh_.triangles[place.triangle];
  std::vector<int> corners;  // of the vertex, edge or triangle that it lies in, ascending
  for (int k = 0; k < 3; ++k)
    if (place.barycentric[k] > 1e-9) corners.push_back(t[k]);
  std::sort(corners.begin(), corners.end());
  if (corners.size() == 1) return vertex_[corners[0]] != 0;
  return corners.size() == 2 &&
         std::binary_search(edges_.begin(), edges_.end(), std::array<int, 2>{corners[0], corners[1]});
}

}  // namespace tensegric_fit::correlation
