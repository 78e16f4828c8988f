#include "inspect/fit_model.hpp"

#include "inspect/colours.hpp"
#include "mesh_files/glb.hpp"

namespace tensegric_fit::inspect {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr char kMorph[] = "under_garment";
constexpr double kTube = 0.004;  // m: a line lies on the skin, and half of the tube in it
constexpr Colour kLine{59, 47, 42};

Points in_body_frame(const Eigen::Isometry3d& body_from_scan, Points points) {
  for (Eigen::Vector3d& p : points) p = body_from_scan * p;
  return points;
}

}  // namespace

std::string fit_glb(const FitScene& scene) {
  const Eigen::Isometry3d& frame = scene.measures.body_from_scan;
  mesh_files::GlbMesh body;
  body.name = "body";
  body.shape = {in_body_frame(frame, scene.before.vertices), scene.before.triangles};
  body.colours = distortion_colours(scene.distortion);
  body.scalars = {{"_DISTORTION", {scene.distortion.begin(), scene.distortion.end()}}};
  body.morphs = {{kMorph, in_body_frame(frame, scene.after)}};
  std::vector<mesh_files::GlbMesh> meshes{std::move(body)};
  for (std::size_t i = 0; i < scene.lines_before.size(); ++i) {
    const Points &before = scene.lines_before[i], &after = scene.lines_after[i];
    if (before.size() < 2 || before.size() != after.size()) continue;
    mesh_files::GlbMesh line;
    line.name = "line " + std::to_string(i);
    line.shape = mesh_files::tube(in_body_frame(frame, before), kTube);
    line.morphs = {{kMorph, mesh_files::tube(in_body_frame(frame, after), kTube).vertices}};
    line.colour = kLine;
    meshes.push_back(std::move(line));
  }
  return mesh_files::glb_bytes(meshes);
}

}  // namespace tensegric_fit::inspect
