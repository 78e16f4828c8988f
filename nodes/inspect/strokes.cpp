#include "inspect/strokes.hpp"

#include "geometry/status.hpp"

namespace tensegric_fit::inspect {
namespace {

constexpr double kStrokeLift = 0.003;  // metres
constexpr Colour kEdge{60, 60, 60};

// Points on the skin, lifted as the control node next to them is.
std::vector<Eigen::Vector3d> lifted_course(const std::vector<Eigen::Vector3d>& course,
                                           const std::vector<Eigen::Vector3d>& outer,
                                           const std::vector<Eigen::Vector3d>& lifted_outer) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : course) {
    std::size_t next = 0;
    for (std::size_t i = 1; i < outer.size(); ++i)
      if ((outer[i] - point).squaredNorm() < (outer[next] - point).squaredNorm()) next = i;
    points.push_back(point + lifted_outer[next] - outer[next]);
  }
  return points;
}

}  // namespace

std::vector<Eigen::Vector3d> lifted(const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3i>& triangles) {
  const std::vector<Eigen::Vector3d> normals = geometry::vertex_normals(outer, triangles);
  std::vector<Eigen::Vector3d> positions = outer;
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += kStrokeLift * normals[i];
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
    Stroke stroke{{}, tension_colour(line.tension)};
    for (const int node : line.nodes) {
      if (node < 0 || node >= static_cast<int>(positions.size()))
        throw geometry::Refusal(geometry::refusal::kBadMesh,
                                "a garment line runs over nodes that are not there");
      stroke.points.push_back(positions[node]);
    }
    // A band's course lies on the body, not over the nodes of its route.
    if (!line.course.empty() && !outer.empty()) stroke.points = lifted_course(line.course, outer, positions);
    if (stroke.points.size() > 1) strokes.push_back(std::move(stroke));
  }
  return strokes;
}

std::vector<Ribbon> band_ribbons(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer,
                                 const std::vector<BandOnSkin>& bands, double blend) {
  const std::vector<Eigen::Vector3d> positions = lifted(outer, control.triangles);
  std::vector<Ribbon> ribbons;
  for (const BandOnSkin& band : bands) {
    Ribbon ribbon{{}, tension_colour(band.tension)};
    for (std::size_t f = 0; f < band.worn.size(); ++f)
      ribbon.fibres.push_back(lifted_course(between(band.at_rest[f], band.worn[f], blend), outer, positions));
    ribbons.push_back(std::move(ribbon));
  }
  return ribbons;
}

std::vector<Eigen::Vector3d> between(const std::vector<Eigen::Vector3d>& rest,
                                     const std::vector<Eigen::Vector3d>& worn, double blend) {
  std::vector<Eigen::Vector3d> points(rest);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += blend * (worn[i] - rest[i]);
  return points;
}

}  // namespace tensegric_fit::inspect
