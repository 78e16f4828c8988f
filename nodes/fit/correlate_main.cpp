/// correlate: a fit and a worn scan -> result files.
#include <iostream>

#include "files/owner_only.hpp"
#include "fit/correlate_line.hpp"
#include "fit/correlation_report.hpp"
#include "fit/result_documents.hpp"
#include "fit/result_folder.hpp"
#include "geometry/percentile.hpp"
#include "geometry/ply.hpp"
#include "geometry/surface_tree.hpp"
#include "inspect/composition.hpp"
#include "inspect/correlation_model.hpp"
#include "inspect/correlation_pictures.hpp"
#include "scan_files/scan_file.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;

const ResultNames kCorrelateResults(std::begin(kCorrelateFiles), std::end(kCorrelateFiles));
const ResultNames kFitted = {kFitReport, kExportDocument, "body.ply", "deformed.ply", "control.ply"};

// m; skin that the garment moves by more is looked at, or all where it moves none.
constexpr double kMoved = 1e-3;
// m; half of that skin is nearer where it is of one scan: 0.02 mm at half of the triangles, 0.04 at a third.
// Two scans of one virtual woman are 0.3 mm apart.
constexpr double kSameSkin = 5e-5;

// Whether the worn scan is the one without the garment: the skin that the garment moves lies where it was.
bool is_same_scan(const FittedFolder& fitted, const geometry::TriangleMesh& worn) {
  std::vector<Eigen::Vector3d> moved;
  for (std::size_t v = 0; v < fitted.deformed.size(); ++v)
    if ((fitted.deformed[v] - fitted.rest.vertices[v]).norm() > kMoved)
      moved.push_back(fitted.rest.vertices[v]);
  if (moved.empty()) moved = fitted.rest.vertices;
  const geometry::SurfaceTree tree(worn);
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : moved) distances.push_back((tree.nearest(p).position - p).norm());
  return geometry::median(distances) < kSameSkin;
}

class Run {
 public:
  explicit Run(const CorrelateLine& line) : line_(line) {}

  // Refusals leave as exceptions.
  void operator()() {
    say("reading the fit");
    fitted_ = read_fitted_folder(line_.fit);
    const Body before = measure_mesh(fitted_.rest, line_.settings, times_);
    say("the worn scan: reconstruction, landmarks");
    const Body worn = worn_body();
    say("alignment, distances");
    const correlation::Correlation result =
        correlate({fitted_.rest, fitted_.deformed, fitted_.control, before.measures},
                  {worn.mesh.mesh, worn.mesh.filled, worn.measures}, line_.options);
    const std::optional<Body> simulated = simulated_body();
    const correlation::Differences differences = correlation::differences_of(
        before.measures, {fitted_.rest, fitted_.deformed}, simulated ? &simulated->measures : nullptr,
        worn.measures, result.alignment.patch_from_scan);
    say("pictures, report");
    const bool same_scan = is_same_scan(fitted_, worn.mesh.mesh);
    if (same_scan)
      std::cerr << "correlate: warning: the worn scan is the one without the garment once more\n";
    write({fitted_, source_, line_.options.thickness, result, differences, same_scan}, before, worn);
  }

  const Source& source() const { return source_; }

 private:
  void say(const std::string& what) const { say_progress(line_.quiet, what); }

  std::string path(const std::string& name) const { return (fs::path(line_.out) / name).string(); }

  Body worn_body() {
    source_.file = line_.mesh.empty() ? line_.worn : line_.mesh;
    if (!line_.mesh.empty()) {
      geometry::TriangleMesh mesh =
          scan_files::read_body_mesh(line_.mesh, line_.asked, false, source_.reading);
      source_.points = mesh.vertices.size();
      return measure_mesh(std::move(mesh), line_.settings, times_);
    }
    scan_files::ScanFile file = scan_files::read_scan_file(line_.worn);
    source_.reading = scan_files::reading_of({file}, line_.asked);
    scan_files::apply(source_.reading, file.cloud);
    const geometry::PointCloud scan = geometry::points_of(file.cloud);
    source_.points = scan.points.size();
    return measure_scan(scan, line_.settings, times_);
  }

  // Nothing where a strong garment leaves a shape that cannot be measured: the distances stand without it.
  std::optional<Body> simulated_body() {
    try {
      return measure_mesh({fitted_.deformed, fitted_.rest.triangles}, line_.settings, times_);
    } catch (const geometry::Refusal&) {
      return std::nullopt;
    }
  }

  PagePicture save(const std::string& name, const cv::Mat& picture, const std::string& caption) const {
    PagePicture page{inspect::png_bytes(picture), caption};
    write_text(path(name), page.png);
    return page;
  }

  void write(const Correlated& correlated, const Body& before, const Body& worn) const {
    const correlation::Correlation& result = correlated.result;
    const geometry::TriangleMesh simulated{fitted_.deformed, fitted_.rest.triangles};
    geometry::TriangleMesh aligned = worn.mesh.mesh;
    for (Eigen::Vector3d& vertex : aligned.vertices) vertex = result.alignment.patch_from_scan * vertex;
    const inspect::CorrelationScene scene{simulated,
                                          fitted_.rest,
                                          aligned,
                                          result.map.distance,
                                          result.map.compared,
                                          before.measures.body_from_scan,
                                          inspect::parts_of(fitted_.control, before.measures.body_from_scan)};
    write_mesh(path("distance.ply"), simulated,
               inspect::distance_colours(result.map.distance, result.map.compared));
    write_text(path("distance.csv"), distance_csv(result));
    const std::vector<PagePicture> pictures = {
        save("distance.png", distance_picture(scene),
             "Where the worn surface lies outside (blue) or inside (red) of the simulated body"),
        save("silhouettes.png", silhouette_picture(scene),
             "Silhouettes from the front or back of the garment and from her left: worn grey, simulated dark "
             "line, before dotted")};
    write_text(path("correlate.html"),
               correlation_page(correlated, pictures, inspect::correlation_glb(scene)));
    write_json(path("correlate.json"), report_of(correlated));
  }

  const CorrelateLine& line_;
  StageTimes times_;
  Source source_;
  FittedFolder fitted_;
};

int run(const CorrelateLine& line) {
  std::vector<std::string> inputs = {line.worn, line.mesh};
  for (const char* name : kFitted) inputs.push_back((fs::path(line.fit) / name).string());
  Run correlate(line);
  return run_into_folder(
      {"correlate", line.out, kCorrelateResults, inputs, [&] { correlate(); },
       [&](const geometry::Refusal& refusal) {
         nlohmann::ordered_json report;
         report["worn"] = {{"file", correlate.source().file}, {"points", correlate.source().points}};
         report["status"] = "refused";
         report["reason"] = {{"code", refusal.code()}, {"message", refusal.what()}};
         write_json(fs::path(line.out) / "correlate.json", report);
       }});
}

}  // namespace
}  // namespace tensegric_fit::fit

int main(int argc, char** argv) {
  tensegric_fit::files::owner_only();
  try {
    tensegric_fit::fit::CorrelateLine line;
    if (const auto exit_code = tensegric_fit::fit::parse(argc, argv, line)) return *exit_code;
    return tensegric_fit::fit::run(line);
  } catch (const std::exception& error) {
    std::cerr << "correlate: " << error.what() << '\n';
    return 1;
  }
}
