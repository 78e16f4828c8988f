#include "fit/maker_export.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "fit/measures_file.hpp"
#include "fit/result_folder.hpp"
#include "inspect/colours.hpp"
#include "mesh_files/glb.hpp"
#include "mesh_files/maker_files.hpp"

namespace tensegric_fit::fit {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kTubeRadius = 0.002;  // m, as thick as a cord
constexpr int kTubePoints = 200;
constexpr std::array<std::uint8_t, 3> kTubeColour{40, 40, 48};
constexpr const char* kWorn = "under the garment";

Points moved(Points points, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3d& p : points) p = motion * p;
  return points;
}

// As many points for a line before and after, in even steps.
Points in_steps(const Points& line, int count) {
  std::vector<double> reached{0};
  for (std::size_t i = 1; i < line.size(); ++i)
    reached.push_back(reached.back() + (line[i] - line[i - 1]).norm());
  Points result;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double at = reached.back() * k / (count - 1);
    while (i + 2 < line.size() && reached[i + 1] < at) ++i;
    const double step = reached[i + 1] - reached[i];
    const double share = step > 0 ? std::clamp((at - reached[i]) / step, 0.0, 1.0) : 0;
    result.push_back(line[i] + share * (line[i + 1] - line[i]));
  }
  return result;
}

std::string glb_of(const geometry::TriangleMesh& rest, const geometry::TriangleMesh& worn, const Fit* fit,
                   const Eigen::Isometry3d& body_from_scan) {
  std::vector<mesh_files::GlbMesh> meshes{{"body", rest}};
  if (fit == nullptr) {
    meshes[0].colour = inspect::kNeutral;
    return mesh_files::glb_bytes(meshes);
  }
  meshes[0].colours = inspect::distortion_colours(fit->distortion);
  meshes[0].scalars = {{"_DISTORTION", {fit->distortion.begin(), fit->distortion.end()}}};
  meshes[0].morphs = {{kWorn, worn.vertices}};
  meshes[0].extras = {{"distortion", "skin area under the garment / before"},
                      {"distortion_colours", {inspect::kTightest, 1, inspect::kLoosest}}};
  for (const tensegric::LineResult& line : fit->solution.lines) {
    if (line.course_at_rest.size() < 2 || line.course.size() < 2) continue;
    const auto tube = [&](const Points& course) {
      return mesh_files::tube(in_steps(moved(course, body_from_scan), kTubePoints), kTubeRadius);
    };
    mesh_files::GlbMesh mesh{"line " + line.name, tube(line.course_at_rest)};
    mesh.morphs = {{kWorn, tube(line.course).vertices}};
    mesh.colour = kTubeColour;
    mesh.extras = {
        {"line", line.name}, {"initial", line.initial}, {"final", line.final}, {"tension", line.tension}};
    meshes.push_back(std::move(mesh));
  }
  return mesh_files::glb_bytes(meshes, {{"measures", "measures.json"}});
}

}  // namespace

void export_for_makers(const std::string& folder, const std::vector<std::string>& formats, const Body& body,
                       const Fit* fit) {
  const auto wanted = [&](const char* format) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  };
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_text((std::filesystem::path(folder) / name).string(), bytes);
  };
  const Eigen::Isometry3d& place = body.measures.body_from_scan;
  const geometry::TriangleMesh rest{moved(body.mesh.mesh.vertices, place), body.mesh.mesh.triangles};
  geometry::TriangleMesh worn;
  if (fit != nullptr) worn = {moved(fit->deformed, place), rest.triangles};
  if (wanted("obj")) write("body.obj", mesh_files::obj_text(rest, "body"));
  if (wanted("stl")) write("body.stl", mesh_files::stl_bytes(rest));
  if (fit != nullptr && wanted("obj")) write("deformed.obj", mesh_files::obj_text(worn, "deformed"));
  if (fit != nullptr && wanted("stl")) write("deformed.stl", mesh_files::stl_bytes(worn));
  if (wanted("glb")) write("fit.glb", glb_of(rest, worn, fit, place));
  if (formats.empty() || (body.measures.girths.empty() && body.measures.heights.empty())) return;
  const std::vector<MeasureEntry> measures = measure_entries(body, fit);
  write_json(std::filesystem::path(folder) / "measures.json", measures_json(measures));
  write("measures.vit", measures_vit(measures, false));
  if (fit != nullptr) write("measures_worn.vit", measures_vit(measures, true));
}

}  // namespace tensegric_fit::fit
