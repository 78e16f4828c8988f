#include "inspect/strokes.hpp"

#include "geometry/status.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kLift = 0.003;  // metres
constexpr Colour kEdge{60, 60, 60};

}  // namespace

std::vector<Eigen::Vector3d> lifted(const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3i>& triangles) {
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(outer, triangles);
  std::vector<Eigen::Vector3d> positions = outer;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += kLift * normals[i];
  return positions;
}

std::vector<Stroke> edge_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer) {
  const std::vector<Eigen::Vector3d> positions = lifted(outer, control.triangles);
  std::vector<Stroke> strokes;
  for (const geometry::Edge& edge : geometry::edges_of({outer, control.triangles}))
    strokes.push_back({{positions[edge.first], positions[edge.second]}, kEdge});
  return strokes;
}

std::vector<Stroke> line_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer,
                                 const std::vector<TenseLine>& lines) {
  const std::vector<Eigen::Vector3d> positions = lifted(outer, control.triangles);
  std::vector<Stroke> strokes;
  for (const TenseLine& line : lines) {
    if (line.nodes.size() < 2) continue;
    Stroke stroke{{}, tension_colour(line.tension)};
    for (const int node : line.nodes) {
      if (node < 0 || node >= static_cast<int>(positions.size()))
        throw geometry::Refusal(geometry::refusal::kBadMesh,
                                "a garment line runs over nodes that are not there");
      stroke.points.push_back(positions[node]);
    }
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

}  // namespace tensegric_fit::inspect
