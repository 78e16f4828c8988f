/// fit: input files -> result files.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <opencv2/imgcodecs.hpp>

#include "body_model/parts.hpp"
#include "files/owner_only.hpp"
#include "fit/command_line.hpp"
#include "fit/compute.hpp"
#include "fit/maker_export.hpp"
#include "fit/result_folder.hpp"
#include "geometry/ply.hpp"
#include "inspect/composition.hpp"
#include "inspect/fit_pictures.hpp"

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
  explicit Run(const CommandLine& line) : line_(line) {}

  void operator()() {
    compute(line_, done_, [this](const std::string& what) { say(what); });
    say("pictures, report");
    write_mesh(path("body.ply"), done_.body.mesh.mesh);
    if (done_.fit) {
      write_fit(*done_.fitting, *done_.fit);
    } else {
      constexpr int kWhole = 900;
      save_picture("front.png", measured(inspect::front_picture, kWhole));
      save_picture("side.png", measured(inspect::side_picture, kWhole));
    }
    export_for_makers(line_.out, line_.exports, done_.body, done_.fit ? &*done_.fit : nullptr);
    const std::size_t triangles = done_.body.mesh.mesh.triangles.size();
    if (!line_.exports.empty() && triangles > kMostMakerTriangles)
      fmt::print(stderr,
                 "note: the exported meshes have {} triangles; CLO takes {} at most: reduce them there, or "
                 "scan with "
                 "--body-triangles {}\n",
                 triangles, kMostMakerTriangles, kMostMakerTriangles);
    write_json(path("report.json"), done_.report());
  }

  const Source& source() const { return done_.source; }

 private:
  void say(const std::string& what) const { say_progress(line_.quiet, what); }

  std::string path(const std::string& name) const { return (fs::path(line_.out) / name).string(); }

  void save_picture(const std::string& name, const cv::Mat& picture) const {
    write_picture(path(name), picture);
  }

  void save_pictures(const Fitting& fitting, const Fit& fit) const {
    inspect::FitScene scene{done_.body.mesh.mesh,
                            fit.deformed,
                            fit.distortion,
                            done_.body.measures,
                            inspect::parts_of(fitting.control, done_.body.measures.body_from_scan),
                            {},
                            {}};
    for (const geometry::FitWarning& warning : done_.warnings)
      if (warning.is_warning())
        scene.warned.insert(scene.warned.end(), warning.vertices.begin(), warning.vertices.end());
    for (const auto& line : fit.solution.lines) {
      for (const auto& [fibres, drawn] :
           {std::pair(&line.fibres_at_rest, &scene.lines_before), {&line.fibres, &scene.lines_after}}) {
        drawn->push_back(fibres->front());  // both edges of a band
        if (fibres->size() > 1) drawn->push_back(fibres->back());
      }
    }
    std::vector<std::function<void()>> pictures{
        [&] {
          save_picture("front.png", beside_measured(inspect::front_picture, inspect::front_picture(scene)));
        },
        [&] {
          save_picture("side.png", beside_measured(inspect::side_picture, inspect::side_picture(scene)));
        },
        [&] { save_picture("distortion.png", inspect::distortion_picture(scene)); }};
    if (std::any_of(scene.parts.begin(), scene.parts.end(), [](const auto& part) { return part.behind; }))
      pictures.emplace_back([&] { save_picture("back.png", inspect::back_picture(scene)); });
    std::vector<std::future<void>> making;
    for (const auto& picture : pictures) making.push_back(std::async(std::launch::async, picture));
    for (std::future<void>& made : making) made.get();
  }

  using MeasuredPicture = cv::Mat (*)(const geometry::TriangleMesh&, const geometry::BodyMeasures&, int,
                                      const inspect::ModelOverlay*);

  cv::Mat measured(MeasuredPicture picture, int height) const {
    const geometry::TriangleMesh& mesh = done_.body.mesh.mesh;
    if (!line_.overlay) return picture(mesh, done_.body.measures, height, nullptr);
    const body_model::RegisteredBody& body = *done_.body.model;
    const inspect::ModelSkin skin{body.skin, body.model->quads, body.model->part, body.model->parts};
    const std::vector<unsigned char> parts = body_model::parts_of(mesh, body);
    const inspect::ModelOverlay overlay{skin, parts};
    return picture(mesh, done_.body.measures, height, &overlay);
  }

  cv::Mat beside_measured(MeasuredPicture picture, const cv::Mat& pictures) const {
    if (line_.is_shape()) return pictures;
    return inspect::side_by_side(inspect::with_caption(measured(picture, kPanel), "measured"), pictures);
  }

  void write_fit(const Fitting& fitting, const Fit& fit) {
    for (const auto& [name, nodes] :
         {std::pair{"control.ply", &fitting.control.outer}, {"control_deformed.ply", &fit.solution.outer}})
      write_mesh(path(name), {*nodes, fitting.control.triangles}, {}, geometry::Coordinates::float64);
    write_mesh(path("deformed.ply"), {fit.deformed, done_.body.mesh.mesh.triangles});
    write_text(path("history.csv"), history_csv(done_.body, fitting, fit.solution));
    save_pictures(fitting, fit);
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
    if (!line.quiet) fmt::print(stderr, "results: {}\n", fs::absolute(line.out).lexically_normal().string());
  };
  return run_into_folder({"fit", line.out, kResults, inputs, work, [&](const geometry::Refusal& refusal) {
                            write_json(fs::path(line.out) / "report.json",
                                       report_of(chain.source(), refusal));
                          }});
}

}  // namespace
}  // namespace tensegric_fit::fit

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  tensegric_fit::fit::CommandLine line;
  if (const auto exit_code = tensegric_fit::fit::parse(argc, argv, line)) return *exit_code;
  return tensegric_fit::fit::run(line);
}
