#include "ros/export_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "files/whole_folder.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "inspect/fit_model.hpp"
#include "inspect/fit_pictures.hpp"
#include "ros/fit_document.hpp"
#include "ros/fit_sheet.hpp"
#include "ros/flat.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;
using files::FileContent;
using geometry::Refusal;

constexpr std::array<const char*, 11> kFiles = {
    kFitDocument, "measurements.csv", "body.ply",       "deformed.ply", "control.ply", "control_deformed.ply",
    "front.png",  "side.png",         "distortion.png", "fit.glb",      "fit.html"};

FileContent png(const std::string& name, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  return {name, {bytes.begin(), bytes.end()}};
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
  for (const LineResult& line : figures.scan.fit->lines) {
    scene.lines_before.push_back(points_in(line.course_at_rest));
    scene.lines_after.push_back(points_in(line.course));
  }
  for (const geometry::FitWarning& warning : figures.scan.warnings)
    if (warning.is_warning())
      scene.warned.insert(scene.warned.end(), warning.vertices.begin(), warning.vertices.end());
  return scene;
}

inspect::FitModel model_of(const FitFigures& figures) {
  inspect::FitModel model{figures.body, figures.deformed, figures.distortion,
                          figures.measures.body_from_scan};
  for (const LineResult& line : figures.scan.fit->lines)
    model.lines.push_back({line.name, points_in(line.course_at_rest), points_in(line.course), line.initial,
                           line.final, line.tension});
  return model;
}

std::vector<FileContent> contents_of(const FitFigures& figures) {
  const geometry::TriangleMesh deformed{figures.deformed, figures.body.triangles};
  const auto& cells = figures.control.triangles;
  constexpr auto kExact = geometry::Coordinates::float64;
  const inspect::FitScene scene = scene_of(figures);
  const FileContent front = png("front.png", inspect::front_picture(scene)),
                    side = png("side.png", inspect::side_picture(scene)),
                    distortion = png("distortion.png", inspect::distortion_picture(scene)),
                    model{"fit.glb", inspect::fit_glb(model_of(figures))};
  return {{kFitDocument, fit_json(figures, {kFiles.begin(), kFiles.end()})},
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
                                 model)}};
}

/// The folder's scan, where it is an export.
std::optional<std::string> exported_scan(const fs::path& folder) {
  if (fs::symlink_status(folder).type() != fs::file_type::directory) return std::nullopt;
  std::ifstream file(folder / kFitDocument);
  return scan_id_in({std::istreambuf_iterator<char>(file), {}});
}

void check_nothing_else_in(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || std::find(kFiles.begin(), kFiles.end(), name) == kFiles.end())
      throw Refusal(
          geometry::refusal::kBadOption,
          fmt::format("'{}' is no part of an export: its folder was not deleted", entry.path().string()));
  }
}

std::vector<fs::path> exports_of(const fs::path& directory, const std::string& scan_id) {
  std::vector<fs::path> folders;
  if (exported_scan(directory) == scan_id) return {directory};
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    if (exported_scan(entry.path()) == scan_id) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

}  // namespace

std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory) {
  files::check_new_folder(directory);
  return files::write_whole_folder(directory, contents_of(figures_of(scan)));
}

std::vector<std::string> delete_exports(const std::string& directory, const std::string& scan_id) {
  fs::path place = fs::path(directory).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();  // a slash at the end
  if (!place.is_absolute() || scan_id.empty())
    throw Refusal(geometry::refusal::kBadOption, "which scan is to be deleted from which absolute path?");
  std::vector<std::string> gone;
  try {
    for (const fs::path& folder : exports_of(place, scan_id)) {
      check_nothing_else_in(folder);
      files::delete_whole_folder(folder);
      gone.push_back(folder);
    }
  } catch (const fs::filesystem_error& error) {
    throw Refusal(geometry::refusal::kCannotWrite,
                  fmt::format("'{}' cannot be looked at: {}", place.string(), error.code().message()));
  }
  if (gone.empty())
    throw Refusal(geometry::refusal::kNothingYet,
                  fmt::format("no export of scan {} in '{}'", scan_id, place.string()));
  return gone;
}

}  // namespace tensegric_fit::node
