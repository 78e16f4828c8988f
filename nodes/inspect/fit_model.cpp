#include "inspect/fit_model.hpp"

#include "geometry/even_steps.hpp"
#include "geometry/points.hpp"
#include "inspect/colours.hpp"
#include "mesh_files/glb.hpp"

namespace tensegric_fit::inspect {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr char kMorph[] = "under the garment";
constexpr double kTubeRadius = 0.004;  // m: a line lies on the skin, and half of the tube in it
constexpr int kTubePoints = 200;
constexpr Colour kTubeColour{40, 40, 48};

// As many points for a line before and after, in even steps.
Points in_steps(const Points& line, int count) {
  Points result;
  for (const auto& [segment, share] : geometry::even_places(line, count))
    result.push_back(line[segment] + share * (line[segment + 1] - line[segment]));
  return result;
}

mesh_files::GlbMesh body_of(const FitModel& model) {
  mesh_files::GlbMesh body{
      "body", {geometry::moved(model.before.vertices, model.body_from_scan), model.before.triangles}};
  if (model.after.empty()) {
    body.colour = kNeutral;
    return body;
  }
  body.colours = distortion_colours(model.distortion);
  body.scalars = {{"_DISTORTION", {model.distortion.begin(), model.distortion.end()}}};
  body.morphs = {{kMorph, geometry::moved(model.after, model.body_from_scan)}};
  body.extras = {{"distortion", "skin area under the garment / before"},
                 {"distortion_colours", {kTightest, 1, kLoosest}}};
  return body;
}

}  // namespace

std::string fit_glb(const FitModel& model) {
  std::vector<mesh_files::GlbMesh> meshes{body_of(model)};
  for (const ModelLine& line : model.lines) {
    if (line.before.size() < 2 || line.after.size() < 2) continue;
    const auto tube = [&](const Points& course) {
      return mesh_files::tube(in_steps(geometry::moved(course, model.body_from_scan), kTubePoints),
                              kTubeRadius);
    };
    mesh_files::GlbMesh mesh{"line " + line.name, tube(line.before)};
    mesh.morphs = {{kMorph, tube(line.after).vertices}};
    mesh.colour = kTubeColour;
    mesh.extras = {{"surface", false},
                   {"line", line.name},
                   {"initial", line.initial},
                   {"final", line.final},
                   {"tension", line.tension}};
    meshes.push_back(std::move(mesh));
  }
  return mesh_files::glb_bytes(meshes);
}

}  // namespace tensegric_fit::inspect
