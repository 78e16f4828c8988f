#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {
namespace {

Junction find_crotch_junction(const SlicedMesh& sliced, const BodyLevels& levels) {
  const Level& parted = levels.parted();
  const Outline *left = &parted.outlines[parted.legs[0]], *right = &parted.outlines[parted.legs[1]];
  if (left->centroid.y() < right->centroid.y()) std::swap(left, right);
  // In statures: the gap between thighs stays this near its middle, and this far up at the most it can be
  // filled.
  const double middle = (left->low.y() + right->high.y()) / 2, reach = 0.008 * levels.stature;
  Junction junction =
      find_junction(sliced, {parted.height - 0.01 * levels.stature, parted.height + 0.11 * levels.stature,
                             middle - reach, middle + reach, left->high.x() - left->low.x()});
  junction.above.y = middle;
  return junction;
}

}  // namespace

BodyShape::BodyShape(geometry::TriangleMesh body_in_its_frame, std::vector<char> unseen_vertices)
    : mesh(std::move(body_in_its_frame)),
      filled(std::move(unseen_vertices)),
      normals(geometry::vertex_normals(mesh.vertices, mesh.triangles)),
      sliced(mesh),
      levels(find_levels(sliced)),
      crotch(find_crotch_junction(sliced, levels)),
      stature(levels.stature) {}

bool BodyShape::unseen(const Eigen::Vector3d& point, double radius) const {
  for (std::size_t v = 0; v < filled.size(); ++v)
    if (filled[v] != 0 && (mesh.vertices[v] - point).squaredNorm() < radius * radius) return true;
  return false;
}

}  // namespace tensegric_fit::landmarks
