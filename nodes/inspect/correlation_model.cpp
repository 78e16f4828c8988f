#include "inspect/correlation_model.hpp"

#include "geometry/points.hpp"
#include "mesh_files/glb.hpp"

namespace tensegric_fit::inspect {

std::string correlation_glb(const CorrelationScene& scene) {
  const auto in_body_frame = [&](const std::vector<Eigen::Vector3d>& points) {
    return geometry::moved(points, scene.body_from_scan);
  };
  mesh_files::GlbMesh body{"body", {in_body_frame(scene.before.vertices), scene.before.triangles}};
  body.colours = distance_colours(scene.distance, scene.compared);
  mesh_files::GlbScalar distance{"_DISTANCE", {}};
  for (std::size_t v = 0; v < scene.distance.size(); ++v)
    distance.values.push_back(scene.compared[v] ? static_cast<float>(scene.distance[v])
                                                : kNotComparedDistance);
  body.scalars = {std::move(distance)};
  body.morphs = {{"simulated", in_body_frame(scene.simulated.vertices)}};
  return mesh_files::glb_bytes(
      {body, {"beside", {in_body_frame(scene.worn.vertices), scene.worn.triangles}}});
}

}  // namespace tensegric_fit::inspect
