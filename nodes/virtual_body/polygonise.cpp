#include "virtual_body/polygonise.hpp"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/status.hpp"

namespace tensegric_fit::virtual_body {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// The half space y >= 0 of the shape, or of its mirror image.
struct Half {
  const Implicit& shape;
  bool left;
  double value(const Vector3d& p) const { return shape.value(left ? p : mirrored(p)); }
  Vector3d project(const Vector3d& p, const Vector3d& mask) const {
    return left ? shape.project(p, mask) : mirrored(shape.project(mirrored(p), mask));
  }
};

struct Grid {
  Vector3d origin;
  Vector3i nodes;
  double spacing;
  std::size_t index(int i, int j, int k) const {
    return i + static_cast<std::size_t>(nodes.x()) * (j + static_cast<std::size_t>(nodes.y()) * k);
  }
};

// Values at all nodes. Blocks whose middle is far from the skin are filled with that value: only its sign
// counts there.
std::vector<double> sample(const Half& half, const Grid& grid) {
  constexpr int block = 4;
  std::vector<double> values(grid.index(0, 0, grid.nodes.z()));
  const double far =
      1.6 * 0.5 * std::sqrt(3.0) * block * grid.spacing;  // 1.6: the shape is not an exact distance
  for (int k0 = 0; k0 < grid.nodes.z(); k0 += block) {
    for (int j0 = 0; j0 < grid.nodes.y(); j0 += block) {
      for (int i0 = 0; i0 < grid.nodes.x(); i0 += block) {
        const Vector3d corner = grid.origin + grid.spacing * Vector3d(i0, j0, k0);
        const double middle = half.value(corner + Vector3d::Constant(0.5 * block * grid.spacing));
        for (int k = k0; k < std::min(k0 + block, grid.nodes.z()); ++k)
          for (int j = j0; j < std::min(j0 + block, grid.nodes.y()); ++j)
            for (int i = i0; i < std::min(i0 + block, grid.nodes.x()); ++i) {
              double v = middle;
              if (std::abs(middle) <= far) {
                v = half.value(grid.origin + grid.spacing * Vector3d(i, j, k));
                // No vertex at a node: triangles round it would have no area.
                v = std::copysign(std::max(std::abs(v), 0.05 * grid.spacing), v);
              }
              values[grid.index(i, j, k)] = v;
            }
      }
    }
  }
  return values;
}

geometry::TriangleMesh marching_cubes(const Grid& grid, const std::vector<double>& values) {
  vtkNew<vtkDoubleArray> scalars;
  scalars->SetArray(const_cast<double*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.nodes.data());
  image->SetOrigin(grid.origin.data());
  image->SetSpacing(grid.spacing, grid.spacing, grid.spacing);
  image->GetPointData()->SetScalars(scalars);
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOff();
  contour->ComputeGradientsOff();
  contour->ComputeScalarsOff();
  contour->Update();

  geometry::TriangleMesh mesh;
  vtkPolyData* surface = contour->GetOutput();
  for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v)
    mesh.vertices.emplace_back(surface->GetPoint(v));
  vtkCellArray* cells = surface->GetPolys();
  vtkIdType corners;
  const vtkIdType* at;
  for (cells->InitTraversal(); cells->GetNextCell(corners, at);)
    mesh.triangles.emplace_back(static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2]));
  return mesh;
}

Grid grid_round(const Implicit& shape, double spacing) {
  const Eigen::AlignedBox3d box = shape.half_box();
  const Vector3d low = box.min() - 2 * spacing * Vector3d::UnitZ();  // the grid starts at y = 0
  return {low, ((box.max() - low) / spacing).array().ceil().cast<int>() + 1, spacing};
}

}  // namespace

geometry::TriangleMesh polygonise(const Implicit& shape, double spacing) {
  const Grid grid = grid_round(shape, spacing);
  geometry::TriangleMesh body;
  std::map<std::pair<double, double>, int>
      seam;  // x, z before projection -> vertex: both halves cut y = 0 alike
  for (const bool left : {true, false}) {
    const Half half{shape, left};
    const geometry::TriangleMesh raw = marching_cubes(grid, sample(half, grid));
    std::vector<int> number(raw.vertices.size());
    for (std::size_t v = 0; v < raw.vertices.size(); ++v) {
      const Vector3d& p = raw.vertices[v];
      const bool on_seam = p.y() == 0;
      if (on_seam && !left) {
        const auto twin = seam.find({p.x(), p.z()});
        if (twin == seam.end())
          throw geometry::Refusal(geometry::refusal::kBadMesh, "the halves do not meet");
        number[v] = twin->second;
        continue;
      }
      number[v] = static_cast<int>(body.vertices.size());
      if (on_seam) seam[{p.x(), p.z()}] = number[v];
      Vector3d skin = half.project(p, on_seam ? Vector3d(1, 0, 1) : Vector3d::Ones());
      if (!on_seam) skin.y() = std::max(skin.y(), 1e-5);
      body.vertices.push_back(left ? skin : mirrored(skin));
    }
    for (const Vector3i& t : raw.triangles) {
      const Vector3i at(number[t[0]], number[t[1]], number[t[2]]);
      body.triangles.push_back(left ? at : Vector3i(at[0], at[2], at[1]));
    }
  }
  if (geometry::cone_volume(body.vertices, body.triangles) < 0)
    for (Vector3i& t : body.triangles) std::swap(t[1], t[2]);
  if (!geometry::is_closed(body))
    throw geometry::Refusal(geometry::refusal::kBadMesh, "the shape's mesh is not closed");
  return body;
}

}  // namespace tensegric_fit::virtual_body
