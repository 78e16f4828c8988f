// Every shipped garment on bodies, for shelves.py: BODY.ply, BODY_GARMENT_PERCENT.ply and warnings.csv.
//   worn_skins --out DIR BODY.ply...
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "control_mesh/template.hpp"
#include "fit/chain.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit {
namespace {

namespace fs = std::filesystem;

const char* const kGarments[] = {"B1", "B2", "B3", "B4", "H1", "H2", "H3", "H4"};

void wear_all(const std::string& file, const std::vector<double>& ratios, bool strings,
              const fit::Settings& settings, const fs::path& out, std::FILE* table) {
  fit::StageTimes times;
  const fit::Body body = fit::measure_mesh(geometry::read_ply_mesh(file), settings, times);
  const std::string name = fs::path(file).stem().string();
  geometry::write_ply_mesh((out / (name + ".ply")).string(), body.mesh.mesh);
  for (const std::string region : {"bust", "hips"}) {
    const fit::Fitting fitting =
        fit::prepare(body,
                     std::vector<control_mesh::Template>{control_mesh::load_template(geometry::yaml_file(
                         geometry::shipped_folder("templates"), region, geometry::refusal::kBadGarment))},
                     settings, times);
    for (const std::string garment_name : kGarments) {
      tensegric::Garment garment =
          tensegric::take_garment(garment_name, geometry::shipped_folder("garments"));
      if (garment.regions.front() != region) continue;
      if (strings)
        for (tensegric::GarmentLine& line : garment.lines) line.width = line.smooth = 0;
      for (const double ratio : ratios) {
        tensegric::set_ratio(garment, "", ratio);
        const fit::Fit fit = fit::wear(body, fitting, garment, settings, times);
        const std::string run = fmt::format("{}_{}_{:.0f}", name, garment_name, 100 * ratio);
        geometry::write_ply_mesh((out / (run + ".ply")).string(), {fit.deformed, body.mesh.mesh.triangles});
        const std::string ended =
            fmt::format("{},{},{},{}", name, run, to_string(fit.solution.status), fit.solution.iterations);
        const auto warnings = fit::warnings_of(body, fitting, fit, settings);
        if (warnings.empty()) fmt::print(table, "{},,,,,\n", ended);
        for (const geometry::FitWarning& warning : warnings)
          fmt::print(table, "{},{},{},{:.2f},{:.2f},{:.3f}\n", ended, warning.code, warning.line,
                     1e4 * warning.area, 1e4 * warning.shelf_area, warning.value);
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
  app.add_option("--ratio", ratios, "Ratios of all lines")->capture_default_str()->allow_extra_args(false);
  app.add_option("--out", out, "Folder")->required();
  tensegric_fit::fit::Settings settings;
  app.add_option("--beta", settings.tffd.beta,
                 "Reach of t-FFD's triangles in their mean radii; 0: the default")
      ->check(CLI::Range(0.0, 20.0));
  bool strings = false;
  app.add_flag("--strings", strings, "Lines without width, over the control mesh, as the papers have them");
  CLI11_PARSE(app, argc, argv);
  std::filesystem::create_directories(out);
  std::FILE* table = std::fopen((out + "/warnings.csv").c_str(), "w");
  if (table == nullptr) {
    fmt::print(stderr, "{}: cannot be written\n", out);
    return 1;
  }
  fmt::print(table, "body,run,status,iterations,code,line,area_cm2,shelf_cm2,value\n");
  for (const std::string& body : bodies) {
    try {
      tensegric_fit::wear_all(body, ratios, strings, settings, out, table);
    } catch (const tensegric_fit::geometry::Refusal& refusal) {
      fmt::print(stderr, "{} refused {}: {}\n", body, refusal.code(), refusal.what());
    }
  }
  std::fclose(table);
  return 0;
}
