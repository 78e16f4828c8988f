#include "ros/export_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "files/whole_folder.hpp"
#include "geometry/ply.hpp"
#include "geometry/shading_normals.hpp"
#include "inspect/composition.hpp"
#include "inspect/fit_model.hpp"
#include "inspect/fit_pictures.hpp"
#include "inspect/warning_words.hpp"
#include "mesh_files/maker_files.hpp"
#include "mesh_files/measures_file.hpp"
#include "ros/export_folders.hpp"
#include "ros/fit_document.hpp"
#include "ros/fit_sheet.hpp"
#include "ros/flat.hpp"
#include "ros/headless.hpp"
#include "ros/sealed.hpp"

namespace tensegric_fit::node {
namespace {

using files::FileContent;

FileContent png(const std::string& name, const cv::Mat& picture) {
  return {name, inspect::png_bytes(picture)};
}

/// Of each region that a line of the garment runs over; of all where there is none.
std::vector<inspect::Part> worn_parts(const FitFigures& figures) {
  const std::vector<inspect::Part> all = inspect::parts_of(figures.control, figures.measures.body_from_scan);
  std::vector<inspect::Part> worn;
  for (std::size_t r = 0; r < all.size(); ++r) {
    std::set<int> nodes;
    for (const Eigen::Vector3i& t : geometry::region_triangles(figures.control, figures.control.regions[r]))
      nodes.insert(t.begin(), t.end());
    const auto runs_over = [&](const LineResult& line) {
      return std::any_of(line.nodes.begin(), line.nodes.end(),
                         [&](std::uint32_t node) { return nodes.count(static_cast<int>(node)) != 0; });
    };
    const auto& lines = figures.scan.fit->lines;
    if (std::any_of(lines.begin(), lines.end(), runs_over)) worn.push_back(all[r]);
  }
  return worn.empty() ? all : worn;
}

inspect::FitScene scene_of(const FitFigures& figures) {
  inspect::FitScene scene{
      figures.body, figures.deformed, figures.distortion, figures.measures, worn_parts(figures), {}, {}};
  scene.normals_before = geometry::shading_normals(figures.body.vertices, figures.body.triangles);
  scene.normals_after = geometry::shading_normals(figures.deformed, figures.body.triangles);
  for (const LineResult& line : figures.scan.fit->lines) {
    scene.lines_before.push_back(points_in(line.course_at_rest));
    scene.lines_after.push_back(points_in(line.course));
  }
  for (const geometry::FitWarning& warning : figures.scan.warnings)
    if (warning.is_warning())
      scene.warned.insert(scene.warned.end(), warning.vertices.begin(), warning.vertices.end());
  return scene;
}

/// As makers' programs take it.
geometry::TriangleMesh in_body_frame(geometry::TriangleMesh mesh, const FitFigures& figures) {
  for (Eigen::Vector3d& p : mesh.vertices) p = figures.measures.body_from_scan * p;
  return mesh;
}

std::vector<FileContent> contents_of(const FitFigures& figures) {
  const geometry::TriangleMesh deformed{figures.deformed, figures.body.triangles};
  const auto& cells = figures.control.triangles;
  constexpr auto kExact = geometry::Coordinates::float64;
  const geometry::TriangleMesh rest = in_body_frame(figures.body, figures),
                               worn = in_body_frame(deformed, figures);
  const mesh_files::WornBody worn_body{figures.in_scan_posture, figures.heights, figures.girths};
  const auto measures = mesh_files::measure_entries(figures.body, figures.measures, &worn_body);
  const inspect::FitScene scene = scene_of(figures);
  const std::string note = inspect::words::missing(figures.measures);
  const auto noted = [&](const cv::Mat& picture) { return inspect::with_note(picture, note); };
  const FileContent front = png("front.png", noted(inspect::front_picture(scene))),
                    side = png("side.png", noted(inspect::side_picture(scene))),
                    distortion = png("distortion.png", noted(inspect::distortion_picture(scene))),
                    model{"fit.glb", fit_model(figures)};
  return {{kFitDocument, fit_json(figures, {kExportFiles.begin(), kExportFiles.end()})},
          {"measurements.csv", measurements_csv(figures)},
          {"body.ply", geometry::ply_bytes(figures.body)},
          {"deformed.ply", geometry::ply_bytes(deformed, inspect::distortion_colours(figures.distortion))},
          {"control.ply", geometry::ply_bytes({figures.control.outer, cells}, {}, kExact)},
          {"control_deformed.ply", geometry::ply_bytes({figures.control_deformed, cells}, {}, kExact)},
          front,
          side,
          distortion,
          model,
          {"fit.html", fit_sheet(figures,
                                 {{front, "From the front: before and after"},
                                  {side, "From the side: before and after"},
                                  {distortion,
                                   "Where the skin is pressed together and "
                                   "where it is stretched"}},
                                 model)},
          {"body.obj", mesh_files::obj_text(rest, "body")},
          {"deformed.obj", mesh_files::obj_text(worn, "deformed")},
          {"body.stl", mesh_files::stl_bytes(rest)},
          {"deformed.stl", mesh_files::stl_bytes(worn)},
          {"measures.json", mesh_files::measures_text(measures)},
          {"measures.vit", mesh_files::measures_vit(measures, false)},
          {"measures_worn.vit", mesh_files::measures_vit(measures, true)}};
}

}  // namespace

std::string fit_model(const FitFigures& figures) {
  inspect::FitModel model{figures.body, figures.deformed, figures.distortion,
                          figures.measures.body_from_scan};
  for (const LineResult& line : figures.scan.fit->lines)
    model.lines.push_back({line.name, points_in(line.course_at_rest), points_in(line.course), line.initial,
                           line.final, line.tension});
  return inspect::fit_glb(model);
}

ExportOptions export_options(Parameters& parameters) {
  ExportOptions options;
  options.with_head = parameters.flag("with_head", options.with_head);
  options.age_recipient = parameters.text("age_recipient", "");
  if (!options.age_recipient.empty()) check_recipient(options.age_recipient);
  return options;
}

std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory,
                                    const ExportOptions& options) {
  files::check_new_folder(directory);
  check_in_no_export(directory);
  FitFigures figures = figures_of(scan);
  if (!options.with_head) figures = headless(std::move(figures));
  std::vector<FileContent> contents = contents_of(figures);
  if (!options.age_recipient.empty())
    contents = {{kSealedDocument, sealed_json(scan.body->scan_id)},
                {kSealedFile, sealed(contents, options.age_recipient)}};
  return files::write_whole_folder(directory, contents);
}

}  // namespace tensegric_fit::node
