// Shipped garments on bodies, for shelves.py: BODY.ply, BODY_GARMENT_PERCENT.ply, warnings.csv, moves.csv and
// lines.csv.
//   worn_skins --out DIR BODY.ply...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "control_mesh/template.hpp"
#include "fit/chain.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kGarments{"B1", "B2", "B3", "B4", "H1", "H2", "H3", "H4"};

// The largest of a vertex's move over the farthest of the nodes that carry it, of vertices that move a
// millimetre and more; and what share of these vertices is above 1.3.
std::pair<double, double> overshoot(const fit::Body& body, const fit::Fitting& fitting, const fit::Fit& fit) {
  const geometry::ControlMesh& control = fitting.control;
  const std::size_t outer = control.outer.size();
  std::vector<double> moves(2 * outer);
  for (std::size_t i = 0; i < outer; ++i) {
    moves[i] = (fit.solution.outer[i] - control.outer[i]).norm();
    moves[outer + i] = (fit.solution.inner[i] - control.inner[i]).norm();
  }
  double most = 0, moved = 0, above = 0;
  const auto& rows = fitting.binding.weights().nodes;
  for (Eigen::Index v = 0; v < rows.outerSize(); ++v) {
    const double own = (fit.deformed[v] - body.mesh.mesh.vertices[v]).norm();
    if (own < 1e-3) continue;
    double farthest = 0;
    for (tffd::SparseRows::InnerIterator m(rows, v); m; ++m) farthest = std::max(farthest, moves[m.col()]);
    most = std::max(most, own / farthest);
    ++moved;
    above += own > 1.3 * farthest;
  }
  return {most, moved > 0 ? above / moved : 0};
}

struct Tables {
  std::FILE *warnings, *moves, *lines;
};

std::string run_of(const std::string& body, const std::string& garment, double ratio) {
  return fmt::format("{}_{}_{:.0f}", body, garment, 100 * ratio);
}

void refuse(const std::string& body, const std::string& garment, const std::vector<double>& ratios,
            const geometry::Refusal& refusal, const Tables& tables) {
  fmt::print(stderr, "{} under {}: {}: {}\n", body, garment, refusal.code(), refusal.what());
  for (const double ratio : ratios)
    fmt::print(tables.warnings, "{},{},refused: {},,,,,,\n", body, run_of(body, garment, ratio),
               refusal.code());
}

void wear_one(const fit::Body& body, const std::string& name, const fit::Fitting& fitting,
              const tensegric::Garment& garment, double ratio, const fit::Settings& settings,
              const fs::path& out, const Tables& tables) {
  fit::StageTimes times;
  const fit::Fit fit = fit::wear(body, fitting, garment, settings, times);
  const std::string run = run_of(name, garment.name, ratio);
  geometry::write_ply_mesh((out / (run + ".ply")).string(), {fit.deformed, body.mesh.mesh.triangles});
  const std::string ended =
      fmt::format("{},{},{},{}", name, run, to_string(fit.solution.status), fit.solution.iterations);
  const auto [most, above] = overshoot(body, fitting, fit);
  fmt::print(tables.moves, "{},{},{:.3f},{:.5f}\n", name, run, most, above);
  for (const tensegric::LineResult& line : fit.solution.lines)
    fmt::print(tables.lines, "{},{},{},{:.6f},{:.3f},{:.3f}\n", name, run, line.name,
               line.final / line.initial, line.newtons, 1e-3 * line.pressure);
  const auto warnings = fit::warnings_of(body, fitting, fit, settings);
  if (warnings.empty()) fmt::print(tables.warnings, "{},,,,,\n", ended);
  for (const geometry::FitWarning& warning : warnings)
    fmt::print(tables.warnings, "{},{},{},{:.2f},{:.2f},{:.3f}\n", ended, warning.code, warning.line,
               1e4 * warning.area, 1e4 * warning.shelf_area, warning.value);
}

void wear_all(const std::string& file, const std::vector<std::string>& words,
              const std::vector<double>& ratios, bool strings, const fit::Settings& settings,
              const fs::path& out, const Tables& tables) {
  const std::string name = fs::path(file).stem().string();
  std::vector<tensegric::Garment> garments;
  for (const std::string& word : words) {
    garments.push_back(tensegric::take_garment(word, geometry::shipped_folder("garments")));
    if (strings)
      for (tensegric::GarmentLine& line : garments.back().lines) line.width = line.smooth = 0;
  }
  fit::StageTimes times;
  std::optional<fit::Body> body;
  try {
    body = fit::measure_mesh(geometry::read_ply_mesh(file), settings, times);
  } catch (const geometry::Refusal& refusal) {
    for (const tensegric::Garment& garment : garments) refuse(name, garment.name, ratios, refusal, tables);
    return;
  }
  geometry::write_ply_mesh((out / (name + ".ply")).string(), body->mesh.mesh);
  std::map<std::string, fit::Fitting> fittings;  // by region
  for (tensegric::Garment& garment : garments) {
    const std::string region = garment.regions.front();
    try {
      if (fittings.count(region) == 0) {
        const control_mesh::Template pattern = control_mesh::load_template(geometry::yaml_file(
            geometry::shipped_folder("templates"), region, geometry::refusal::kBadGarment));
        fittings.emplace(region,
                         fit::prepare(*body, std::vector<control_mesh::Template>{pattern}, settings, times));
      }
    } catch (const geometry::Refusal& refusal) {
      refuse(name, garment.name, ratios, refusal, tables);
      continue;
    }
    for (const double ratio : ratios) {
      try {
        if (ratio > 0) tensegric::set_ratio(garment, "", ratio);
        wear_one(*body, name, fittings.at(region), garment, ratio, settings, out, tables);
      } catch (const geometry::Refusal& refusal) {
        refuse(name, garment.name, {ratio}, refusal, tables);
      }
    }
  }
}

}  // namespace
}  // namespace tensegric_fit

int main(int argc, char** argv) {
  CLI::App app("Every shipped garment on bodies, as meshes that another program can look at.");
  std::vector<std::string> bodies;
  std::vector<double> ratios{0.95, 0.92, 0.88, 0.85};
  std::string out;
  app.add_option("bodies", bodies, "Body meshes, BODY.ply")->required();
  app.add_option("--ratio", ratios, "Ratios of all lines; 0: the garment's own")
      ->capture_default_str()
      ->allow_extra_args(false);
  app.add_option("--out", out, "Folder")->required();
  std::vector<std::string> garments = tensegric_fit::kGarments;
  app.add_option("--garment", garments, "Shipped garments, or FILE.yaml; default: all of the papers")
      ->allow_extra_args(false);
  tensegric_fit::fit::Settings settings;
  std::string tissue;
  app.add_option("--tissue", tissue, "Parameter file of another tissue");
  app.add_option("--control-triangles", settings.control_mesh.control_triangles, "At least");
  app.add_option("--beta", settings.tffd.beta,
                 "Reach of t-FFD's triangles in their mean radii; 0: the default")
      ->check(CLI::Range(0.0, 20.0));
  bool strings = false;
  app.add_flag("--strings", strings, "Lines without width, over the control mesh, as the papers have them");
  CLI11_PARSE(app, argc, argv);
  std::filesystem::create_directories(out);
  const tensegric_fit::Tables tables{std::fopen((out + "/warnings.csv").c_str(), "w"),
                                     std::fopen((out + "/moves.csv").c_str(), "w"),
                                     std::fopen((out + "/lines.csv").c_str(), "w")};
  if (tables.warnings == nullptr || tables.moves == nullptr || tables.lines == nullptr) {
    fmt::print(stderr, "{}: cannot be written\n", out);
    return 1;
  }
  fmt::print(tables.warnings, "body,run,status,iterations,code,line,area_cm2,shelf_cm2,value\n");
  fmt::print(tables.moves, "body,run,overshoot,share_above_1.3\n");
  fmt::print(tables.lines, "body,run,line,ratio,newtons,kilopascals\n");
  try {
    if (!tissue.empty()) tensegric_fit::fit::take_tissue(tissue, settings);
    for (const std::string& body : bodies)
      tensegric_fit::wear_all(body, garments, ratios, strings, settings, out, tables);
  } catch (const tensegric_fit::geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  }
  std::fclose(tables.warnings);
  std::fclose(tables.moves);
  std::fclose(tables.lines);
  return 0;
}
