/// fit: input files -> result files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "files/owner_only.hpp"
#include "fit/command_line.hpp"
#include "fit/compute.hpp"
#include "fit/effects.hpp"
#include "fit/maker_export.hpp"
#include "fit/picture_files.hpp"
#include "fit/result_documents.hpp"
#include "fit/result_folder.hpp"
#include "geometry/fit_warning.hpp"
#include "geometry/ply.hpp"
#include "inspect/warning_words.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;

const ResultNames kResults = [] {
  ResultNames names = {kFitReport,     "body.ply",      "control.ply", "control_deformed.ply",
                       "deformed.ply", "history.csv",   "front.png",   "side.png",
                       "back.png",     "distortion.png"};
  names.insert(names.end(), std::begin(kMakerFiles), std::end(kMakerFiles));
  names.insert(names.end(), std::begin(kCorrelateFiles), std::end(kCorrelateFiles));
  return names;
}();

constexpr double kLeastEffect = 0.05;  // mm: what is printed

class Run {
 public:
  explicit Run(const CommandLine& line) : line_(line) {}

  void operator()() {
    compute(line_, done_, [this](const std::string& what) { say(what); });
    say("pictures, report");
    write_mesh(path("body.ply"), done_.body.mesh.mesh);
    if (done_.fit) {
      write_fit(*done_.fitting, *done_.fit);
    } else {
      write_pictures(pictures_of(done_.body, wishes()));
    }
    export_for_makers(line_.out, line_.exports, done_.body, done_.fit ? &*done_.fit : nullptr);
    const std::size_t triangles = done_.body.mesh.mesh.triangles.size();
    if (!line_.exports.empty() && triangles > kMostMakerTriangles)
      fmt::print(stderr,
                 "note: the exported meshes have {} triangles; CLO takes {} at most: reduce them there, or "
                 "scan with "
                 "--body-triangles {}\n",
                 triangles, kMostMakerTriangles, kMostMakerTriangles);
    write_json(path(kFitReport), done_.report());
  }

  const Source& source() const { return done_.source; }

  /// What the garment does, where it does anything, and what is to be known of that.
  void say_outcome() const {
    if (!done_.fit) return;
    std::vector<std::string> words;
    for (const Effect& effect : effects_of(done_.body, *done_.fit))
      if (const double mm = 1e3 * (effect.after - effect.before); std::abs(mm) >= kLeastEffect)
        words.push_back(fmt::format("{} {:+.1f} mm", effect.name, mm));
    if (!words.empty()) fmt::print(stderr, "effects: {}\n", fmt::join(words, ", "));
    const tensegric::Solution& solution = done_.fit->solution;
    if (solution.status != tensegric::Status::converged)
      fmt::print(stderr, "warning: the solver ended {}{}{}\n", to_string(solution.status),
                 solution.note.empty() ? "" : ": ", solution.note);
    for (const geometry::FitWarning& warning : done_.warnings)
      if (warning.is_warning() || warning.code == geometry::notice::kNotScanned)
        fmt::print(stderr, "warning: {}\n", inspect::words::warning(warning, done_.body.measures));
  }

 private:
  void say(const std::string& what) const { say_progress(line_.quiet, what); }

  std::string path(const std::string& name) const { return (fs::path(line_.out) / name).string(); }

  PictureWishes wishes() const { return {!line_.is_shape(), line_.overlay}; }

  void write_pictures(const std::vector<PictureFile>& pictures) const {
    for (const PictureFile& picture : pictures) write_text(path(picture.name), picture.png);
  }

  void write_fit(const Fitting& fitting, const Fit& fit) {
    for (const auto& [name, nodes] :
         {std::pair{"control.ply", &fitting.control.outer}, {"control_deformed.ply", &fit.solution.outer}})
      write_mesh(path(name), {*nodes, fitting.control.triangles}, {}, geometry::Coordinates::float64);
    write_mesh(path("deformed.ply"), {fit.deformed, done_.body.mesh.mesh.triangles});
    write_text(path("history.csv"), history_csv(done_.body, fitting, fit.solution));
    write_pictures(pictures_of(done_.body, fitting, fit, done_.warnings, wishes()));
  }

  const CommandLine& line_;
  Computed done_;
};

int run(const CommandLine& line) {
  std::vector<std::string> inputs{line.mesh, line.garment, line.tissue, line.control, line.fixed};
  inputs.insert(inputs.end(), line.scans.begin(), line.scans.end());
  Run chain(line);
  const auto work = [&] {
    chain();
    if (line.quiet) return;
    chain.say_outcome();
    fmt::print(stderr, "results: {}\n", fs::absolute(line.out).lexically_normal().string());
  };
  return run_into_folder({"fit", line.out, kResults, inputs, work, [&](const geometry::Refusal& refusal) {
                            write_json(fs::path(line.out) / kFitReport, report_of(chain.source(), refusal));
                          }});
}

}  // namespace
}  // namespace tensegric_fit::fit

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  try {
    tensegric_fit::fit::CommandLine line;
    if (const auto exit_code = tensegric_fit::fit::parse(argc, argv, line)) return *exit_code;
    return tensegric_fit::fit::run(line);
  } catch (const std::exception& error) {
    std::cerr << "fit: " << error.what() << '\n';
    return 1;
  }
}
