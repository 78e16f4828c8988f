#include "fit/run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <future>
#include <opencv2/imgcodecs.hpp>

#include "body_model/parts.hpp"
#include "body_model/registration.hpp"
#include "control_mesh/shape_control.hpp"
#include "fit/maker_export.hpp"
#include "fit/report.hpp"
#include "fit/result_folder.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/ply.hpp"
#include "geometry/shipped_files.hpp"
#include "inspect/composition.hpp"
#include "inspect/fit_pictures.hpp"
#include "scan_files/scan_file.hpp"
#include "tensegric/load_unit.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;

const ResultNames kResults = [] {
  ResultNames names = {"report.json",  "body.ply",      "control.ply", "control_deformed.ply",
                       "deformed.ply", "history.csv",   "front.png",   "side.png",
                       "back.png",     "distortion.png"};
  names.insert(names.end(), std::begin(kMakerFiles), std::end(kMakerFiles));
  return names;
}();

constexpr int kPanel = 750;  // pixels; the height of the pictures of a fit

class Run {
 public:
  explicit Run(const CommandLine& line) : line_(line), settings_(line.settings) {
    source_.customer = line.customer;
  }

  // The chain: launch/pages/architecture.md. Refusals leave as exceptions.
  void operator()() {
    const bool measured_only = line_.garment.empty() && !line_.is_shape();
    load_body();
    write_mesh("body.ply", body_.mesh.mesh);
    if (measured_only) {
      constexpr int kWhole = 900;
      save_picture("front.png", measured(inspect::front_picture, kWhole));
      save_picture("side.png", measured(inspect::side_picture, kWhole));
      export_for_makers(line_.out, line_.exports, body_, nullptr);
      write_report(nullptr, nullptr);
      return;
    }
    const tensegric::Garment garment = load_garment();
    source_.garment = garment.name;
    if (const std::string tissue = tissue_file(); !tissue.empty()) take_tissue(tissue, settings_);
    if (line_.posture.twist != 0 || line_.posture.side_lean != 0)
      settings_.solver.bones = geometry::BoneFrames(body_.measures, line_.posture);
    const Fitting fitting = prepare_fitting(garment);
    settings_.solver.gravity =
        tensegric::force_of_share(fitting.model, line_.gravity, settings_.solver, fitting.body_volumes);
    settings_.solver.track = tracked_nodes(fitting.control);
    say("tensegric deformation");
    const Fit fit = wear(body_, fitting, garment, settings_, times_);
    warnings_ = warnings_of(body_, fitting, fit, settings_);
    write_fit(fitting, fit);
  }

  const Source& source() const { return source_; }

 private:
  void say(const std::string& what) const {
    if (!line_.quiet && isatty(STDERR_FILENO) != 0) fmt::print(stderr, "{} ...\n", what);
  }

  std::string path(const std::string& name) const { return (fs::path(line_.out) / name).string(); }

  void write_mesh(const std::string& name, const geometry::TriangleMesh& mesh) const {
    geometry::write_ply_mesh(path(name), mesh);
  }

  void save_picture(const std::string& name, const cv::Mat& picture) const {
    if (!cv::imwrite(path(name), picture)) throw std::runtime_error(path(name) + ": cannot be written");
  }

  void load_body() {
    std::future<void> loading;  // of the body model, while files are read; a broken one is refused at its use
    if (!line_.is_shape()) loading = std::async(std::launch::async, [] { body_model::shipped_registrar(); });
    if (!line_.mesh.empty()) {
      source_.file = line_.mesh;
      say("reading the mesh");
      geometry::TriangleMesh mesh =
          scan_files::read_body_mesh(line_.mesh, line_.asked, line_.is_shape(), source_.reading);
      source_.points = mesh.vertices.size();
      body_ =
          line_.is_shape() ? take_mesh(std::move(mesh)) : measure_mesh(std::move(mesh), settings_, times_);
      return;
    }
    source_.file = line_.scans.front();
    source_.more.assign(line_.scans.begin() + 1, line_.scans.end());
    say("reading the scan");
    const geometry::PointCloud scan = read_scans();
    source_.points = scan.points.size();
    say("reconstruction, landmarks");
    body_ = measure_scan(scan, settings_, times_);
  }

  geometry::PointCloud read_scans() {
    std::vector<scan_files::ScanFile> files;
    for (const std::string& file : line_.scans) files.push_back(scan_files::read_scan_file(file));
    source_.reading = scan_files::reading_of(files, line_.asked);
    std::vector<geometry::PointCloud> parts;
    for (scan_files::ScanFile& file : files) {
      scan_files::apply(source_.reading, file.cloud);
      parts.push_back(geometry::points_of(file.cloud));
    }
    return geometry::joined(parts);
  }

  // The defaults are calibrated for the shipped templates as they are; finer ones have tissue of their own.
  std::string tissue_file() const {
    const bool finer = settings_.control_mesh.control_triangles > control_mesh::Options().control_triangles &&
                       !line_.is_shape();
    return line_.tissue.empty() && finer ? geometry::shipped_folder("tissue") + "/fine.yaml" : line_.tissue;
  }

  tensegric::Garment load_garment() const {
    if (line_.garment.empty()) return {};
    return adjusted(tensegric::take_garment(line_.garment, geometry::shipped_folder("garments")), line_);
  }

  Fitting prepare_fitting(const tensegric::Garment& garment) {
    say("control mesh");
    if (line_.is_shape()) {
      const auto fixing = control_mesh::load_shape_fixing(line_.fixed);
      return prepare(body_,
                     line_.control.empty()
                         ? control_mesh::simplified_control(body_.mesh.mesh, fixing,
                                                            settings_.control_mesh.control_triangles)
                         : control_mesh::control_from_shape(geometry::read_ply_mesh(line_.control), fixing),
                     settings_, times_);
    }
    std::vector<control_mesh::Template> patterns;
    const std::string folder =
        line_.templates.empty() ? geometry::shipped_folder("templates") : line_.templates;
    for (const std::string& region : garment.regions)
      patterns.push_back(
          control_mesh::load_template(geometry::yaml_file(folder, region, geometry::refusal::kBadGarment)));
    return prepare(body_, patterns, settings_, times_);
  }

  void save_pictures(const Fitting& fitting, const Fit& fit) const {
    inspect::FitScene scene{body_.mesh.mesh,
                            fit.deformed,
                            fit.distortion,
                            body_.measures,
                            inspect::parts_of(fitting.control, body_.measures.body_from_scan),
                            {},
                            {}};
    for (const geometry::FitWarning& warning : warnings_)
      if (warning.is_warning())
        scene.warned.insert(scene.warned.end(), warning.vertices.begin(), warning.vertices.end());
    for (const auto& line : fit.solution.lines) {
      for (const auto& [fibres, drawn] :
           {std::pair(&line.fibres_at_rest, &scene.lines_before), {&line.fibres, &scene.lines_after}}) {
        drawn->push_back(fibres->front());  // both edges of a band
        if (fibres->size() > 1) drawn->push_back(fibres->back());
      }
    }
    save_picture("front.png", beside_measured(inspect::front_picture, inspect::front_picture(scene)));
    save_picture("side.png", beside_measured(inspect::side_picture, inspect::side_picture(scene)));
    if (std::any_of(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.behind; }))
      save_picture("back.png", inspect::back_picture(scene));
    save_picture("distortion.png", inspect::distortion_picture(scene));
  }

  using MeasuredPicture = cv::Mat (*)(const geometry::TriangleMesh&, const geometry::BodyMeasures&, int,
                                      const inspect::ModelOverlay*);

  cv::Mat measured(MeasuredPicture picture, int height) const {
    const geometry::TriangleMesh& mesh = body_.mesh.mesh;
    if (!line_.overlay) return picture(mesh, body_.measures, height, nullptr);
    const body_model::RegisteredBody& body = *body_.model;
    const inspect::ModelSkin skin{body.skin, body.model->quads, body.model->part, body.model->parts};
    const std::vector<unsigned char> parts = body_model::parts_of(mesh, body);
    const inspect::ModelOverlay overlay{skin, parts};
    return picture(mesh, body_.measures, height, &overlay);
  }

  cv::Mat beside_measured(MeasuredPicture picture, const cv::Mat& pictures) const {
    if (line_.is_shape()) return pictures;
    return inspect::side_by_side(inspect::with_caption(measured(picture, kPanel), "measured"), pictures);
  }

  void write_fit(const Fitting& fitting, const Fit& fit) {
    say("pictures, report");
    for (const auto& [name, nodes] :
         {std::pair{"control.ply", &fitting.control.outer}, {"control_deformed.ply", &fit.solution.outer}})
      geometry::write_ply_mesh(path(name), {*nodes, fitting.control.triangles}, {},
                               geometry::Coordinates::float64);
    write_mesh("deformed.ply", {fit.deformed, body_.mesh.mesh.triangles});
    write_text(path("history.csv"), history_csv(body_, fitting, fit.solution));
    save_pictures(fitting, fit);
    export_for_makers(line_.out, line_.exports, body_, &fit);
    write_report(&fitting, &fit);
  }

  void write_report(const Fitting* fitting, const Fit* fit) const {
    write_json(path("report.json"), report_of(source_, body_, fitting, fit, warnings_, settings_, times_));
  }

  const CommandLine& line_;
  Settings settings_;
  StageTimes times_;
  Source source_;
  Body body_;
  std::vector<geometry::FitWarning> warnings_;
};

}  // namespace

int run(const CommandLine& line) {
  std::vector<const std::string*> inputs{&line.mesh, &line.garment, &line.tissue, &line.control, &line.fixed};
  for (const std::string& file : line.scans) inputs.push_back(&file);
  if (const std::string* input = endangered_input(inputs, line.out, kResults)) {
    fmt::print(stderr, "--out: the results would overwrite the input {}\n", *input);
    return 2;
  }
  Run chain(line);
  try {
    fs::create_directories(line.out);
    remove_results(line.out, kResults);
    chain();
    if (!line.quiet) fmt::print(stderr, "results: {}\n", fs::absolute(line.out).lexically_normal().string());
    return 0;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    remove_results(line.out, kResults);
    try {
      write_json(fs::path(line.out) / "report.json", report_of(chain.source(), refusal));
    } catch (const std::exception& error) {
      fmt::print(stderr, "fit: {}\n", error.what());
    }
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "fit: {}\n", error.what());
    remove_results(line.out, kResults);
    return 1;
  }
}

}  // namespace tensegric_fit::fit
