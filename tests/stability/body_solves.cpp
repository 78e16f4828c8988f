/// Iterations and ends of the equilibrium solver on bodies: every shipped garment at every request, a row a
/// solve as CSV on standard output, a table of medians and worst cases by request on standard error.
///   body_solves BODY.ply... --control-triangles 480 --tissue launch/tissue/fine.yaml > solves.csv
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "control_mesh/fit_template.hpp"
#include "fit/chain.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/percentile.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "tensegric/solver.hpp"

namespace {

using namespace tensegric_fit;
using tensegric::Status;

constexpr const char* kCode = geometry::refusal::kBadOption;

struct Solves {
  std::vector<int> iterations;
  std::vector<double> ms;
  std::map<std::string, int> statuses;  ///< and refusals
};

std::string row_of(const std::string& name, const Solves& all) {
  std::string ends;
  for (const auto& [status, count] : all.statuses)
    ends += fmt::format("{}{} {}", ends.empty() ? "" : ", ", count, status);
  const std::vector<double> iterations(all.iterations.begin(), all.iterations.end());
  if (iterations.empty()) return fmt::format("| {} | 0 | {} | | | | | |\n", name, ends);
  const auto above = std::count_if(iterations.begin(), iterations.end(), [](double i) { return i > 15; });
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.1f} / {:.1f} / {:.0f} |\n", name,
                     iterations.size(), ends, geometry::percentile(iterations, 0.5),
                     geometry::percentile(iterations, 0.95), geometry::percentile(iterations, 1), above,
                     geometry::percentile(all.ms, 0.5), geometry::percentile(all.ms, 0.95),
                     geometry::percentile(all.ms, 1));
}

class Bodies {
 public:
  explicit Bodies(fit::Settings settings) : settings_(std::move(settings)) {}

  void wear_all(const std::string& path, const std::vector<std::string>& garments,
                const std::vector<double>& requests) {
    const std::string name = std::filesystem::path(path).stem().string();
    fit::StageTimes times;
    std::optional<fit::Body> measured;
    try {
      measured = fit::measure_mesh(geometry::read_ply_mesh(path), settings_, times);
    } catch (const geometry::Refusal& refusal) {
      for (const std::string& word : garments) refuse(name, word, requests, refusal);
      return;
    }
    const fit::Body& body = *measured;
    std::map<std::string, fit::Fitting> fittings;  // by region
    for (const std::string& word : garments) {
      tensegric::Garment garment =
          tensegric::load_garment(geometry::yaml_file(geometry::shipped_folder("garments"), word, kCode));
      const std::string region = garment.regions.front();
      std::vector<geometry::LaidLine> laid;
      try {
        if (fittings.count(region) == 0) fittings.emplace(region, fitting_on(body, region));
        laid = fit::laid_lines(body, fittings.at(region), garment);
      } catch (const geometry::Refusal& refusal) {
        refuse(name, word, requests, refusal);
        continue;
      }
      for (double request : requests) {
        try {
          tensegric::set_ratio(garment, "", request);
          solve(name, word, request, fittings.at(region).model, garment, laid);
        } catch (const geometry::Refusal& refusal) {
          refuse(name, word, {request}, refusal);
        }
      }
    }
  }

  std::string table() const {
    std::string text =
        "| request | solves | ended | iterations: median | 95 % | most | above 15 | ms: median / 95 % / most "
        "|\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (auto at = by_request_.rbegin(); at != by_request_.rend(); ++at)
      text += row_of(fmt::format("{:.2f}", at->first), at->second);
    return text;
  }

 private:
  fit::Fitting fitting_on(const fit::Body& body, const std::string& region) const {
    const control_mesh::Template pattern = control_mesh::load_template(
        geometry::yaml_file(geometry::shipped_folder("templates"), region, kCode));
    fit::StageTimes times;
    return fit::prepare(body, std::vector<control_mesh::Template>{pattern}, settings_, times);
  }

  // A row each, and a place in the table: what is refused is not to be missed.
  void refuse(const std::string& body, const std::string& garment, const std::vector<double>& requests,
              const geometry::Refusal& refusal) {
    for (const double request : requests) {
      fmt::print("{},{},{:.2f},refused: {},,,,,,\n", body, garment, request, refusal.code());
      ++by_request_[request].statuses["refused: " + refusal.code()];
    }
  }

  void solve(const std::string& body, const std::string& garment_name, double request,
             const tensegric::Model& model, const tensegric::Garment& garment,
             const std::vector<geometry::LaidLine>& laid) {
    const auto start = std::chrono::steady_clock::now();
    const tensegric::Solution solution =
        tensegric::solve(model, garment, settings_.solver, nullptr, {}, {}, laid);
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    double moved = 0, volume = 0, length = 0, tension = 0;
    for (std::size_t i = 0; i < solution.outer.size(); ++i)
      moved += (solution.outer[i] - model.control.outer[i]).squaredNorm();
    moved = std::sqrt(moved / static_cast<double>(solution.outer.size()));
    for (const tensegric::RegionResult& r : solution.regions)
      volume = std::max(volume, std::abs(r.volume_after / r.volume_before - 1));
    for (const tensegric::LineResult& l : solution.lines) {
      length = std::max(length, l.final / l.neutral - 1);
      tension = std::max(tension, l.tension);
    }
    fmt::print("{},{},{:.2f},{},{},{:.2f},{:.9g},{:.9g},{:.1e},{:.1e}\n", body, garment_name, request,
               to_string(solution.status), solution.iterations, ms, 1e3 * moved, tension, length, volume);
    std::fflush(stdout);
    Solves& at = by_request_[request];
    at.iterations.push_back(solution.iterations);
    at.ms.push_back(ms);
    ++at.statuses[to_string(solution.status)];
  }

  fit::Settings settings_;
  std::map<double, Solves> by_request_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Iterations of the equilibrium solver on bodies: every garment at every request");
  std::vector<std::string> meshes, garments = {"B1", "B2", "B3", "B4", "H1", "H2", "H3", "H4"};
  std::vector<double> requests = {0.97, 0.95, 0.90, 0.85, 0.80};
  std::string tissue;
  fit::Settings settings;
  app.add_option("meshes", meshes, "BODY.ply...")->required();
  app.add_option("--garments", garments, "shipped ones")->delimiter(',');
  app.add_option("--requests", requests, "ratios")->delimiter(',');
  app.add_option("--tissue", tissue, "parameter file");
  app.add_option("--control-triangles", settings.control_mesh.control_triangles, "at least");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!tissue.empty()) fit::take_tissue(tissue, settings);
    fmt::print("body,garment,request,status,iterations,ms,moved_rms_mm,tension,line_too_long,volume_error\n");
    Bodies bodies(settings);
    for (const std::string& mesh : meshes) bodies.wear_all(mesh, garments, requests);
    fmt::print(stderr, "{}", bodies.table());
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    return 3;
  }
}
