#include "fit/maker_export.hpp"

#include <algorithm>
#include <filesystem>

#include "fit/result_folder.hpp"
#include "geometry/moved_skin.hpp"
#include "geometry/points.hpp"
#include "inspect/fit_model.hpp"
#include "mesh_files/maker_files.hpp"
#include "mesh_files/measures_file.hpp"

namespace tensegric_fit::fit {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::string glb_of(const Body& body, const Fit* fit) {
  const Points nowhere;
  const std::vector<double> none;
  inspect::FitModel model{body.mesh.mesh, fit ? fit->deformed : nowhere, fit ? fit->distortion : none,
                          body.measures.body_from_scan};
  if (fit)
    for (const tensegric::LineResult& line : fit->solution.lines)
      model.lines.push_back(
          {line.name, line.course_at_rest, line.course, line.initial, line.final, line.tension});
  return inspect::fit_glb(model);
}

std::vector<mesh_files::MeasureEntry> measures_of(const Body& body, const Fit* fit) {
  if (fit == nullptr) return mesh_files::measure_entries(body.mesh.mesh, body.measures, nullptr);
  const Points after = geometry::in_scan_posture(body.mesh.mesh, fit->deformed, fit->bones);
  const geometry::MovedSkin skin{body.mesh.mesh, after};
  const std::vector<geometry::ChangedMeasure> heights = geometry::heights_after(body.measures, skin),
                                              girths = geometry::girths_after(body.measures, skin);
  const mesh_files::WornBody worn{after, heights, girths};
  return mesh_files::measure_entries(body.mesh.mesh, body.measures, &worn);
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
  const geometry::TriangleMesh rest{geometry::moved(body.mesh.mesh.vertices, place),
                                    body.mesh.mesh.triangles};
  geometry::TriangleMesh worn;
  if (fit != nullptr) worn = {geometry::moved(fit->deformed, place), rest.triangles};
  if (wanted("obj")) write("body.obj", mesh_files::obj_text(rest, "body"));
  if (wanted("stl")) write("body.stl", mesh_files::stl_bytes(rest));
  if (fit != nullptr && wanted("obj")) write("deformed.obj", mesh_files::obj_text(worn, "deformed"));
  if (fit != nullptr && wanted("stl")) write("deformed.stl", mesh_files::stl_bytes(worn));
  if (wanted("glb")) write("fit.glb", glb_of(body, fit));
  if (formats.empty() || (body.measures.girths.empty() && body.measures.heights.empty())) return;
  const std::vector<mesh_files::MeasureEntry> measures = measures_of(body, fit);
  write("measures.json", mesh_files::measures_text(measures));
  write("measures.vit", mesh_files::measures_vit(measures, false));
  if (fit != nullptr) write("measures_worn.vit", mesh_files::measures_vit(measures, true));
}

}  // namespace tensegric_fit::fit
