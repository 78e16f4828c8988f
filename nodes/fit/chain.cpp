#include "fit/chain.hpp"

#include <chrono>

#include "body_model/missing_parts.hpp"
#include "fit/bind_body.hpp"
#include "tffd/body_volume.hpp"
#include "tffd/distortion.hpp"
#include "tffd/garment_check.hpp"

namespace tensegric_fit::fit {
namespace {

// Adds the wall clock of its scope to `sum`.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() {
    sum_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

geometry::BodyMeasures measures_of(const Body& body) {
  geometry::BodyMeasures measures = landmarks::find_landmarks(body.mesh.mesh, body.mesh.filled, *body.model,
                                                              landmarks::shipped_precision());
  for (geometry::Missing& part : body_model::missing_parts(*body.model))
    measures.missing.push_back(std::move(part));
  return measures;
}

}  // namespace

Body measure_scan(const geometry::PointCloud& scan, const Settings& settings, StageTimes& times) {
  Body body;
  {
    const Stopwatch watch(times.reconstruction);
    const auto registered = [&times](const body_model::Samples& samples) {
      const Stopwatch registration(times.body_model);
      return body_model::shipped_registrar()(samples);
    };
    reconstruction::Reconstruction result = reconstruction::reconstruct(
        scan, settings.reconstruction, {registered, body_model::shipped_registrar().standing()});
    body.mesh = std::move(result.body);
    body.model = std::move(result.model);
  }
  times.reconstruction -= times.body_model;
  const Stopwatch watch(times.landmarks);
  body.measures = measures_of(body);
  geometry::doubt_fractured(body.mesh.fractures, body.measures);
  return body;
}

Body measure_mesh(geometry::TriangleMesh mesh, const Settings&, StageTimes& times) {
  Body body = take_mesh(std::move(mesh));
  {
    const Stopwatch watch(times.body_model);
    body.model = body_model::register_mesh(body_model::shipped_registrar(), body.mesh.mesh);
  }
  const Stopwatch watch(times.landmarks);
  body.measures = measures_of(body);
  return body;
}

Body take_mesh(geometry::TriangleMesh mesh) {
  geometry::check_mesh(mesh);
  Body body;
  body.mesh.points_used = mesh.vertices.size();
  body.mesh.filled.assign(mesh.vertices.size(), 0);
  body.mesh.mesh = std::move(mesh);
  return body;
}

Fitting prepare(const Body& body, const std::vector<control_mesh::Template>& patterns,
                const Settings& settings, StageTimes& times) {
  std::vector<geometry::ControlMesh> parts;
  {
    const Stopwatch watch(times.control_mesh);
    const control_mesh::BodySkin skin(body.mesh.mesh, body.measures, body.model ? &*body.model : nullptr);
    for (const control_mesh::Template& pattern : patterns)
      parts.push_back(control_mesh::fit_template_for_each(pattern, skin, {settings.control_mesh}).front());
  }
  return prepare(body, geometry::joined(parts), settings, times);
}

Fitting prepare(const Body& body, geometry::ControlMesh control, const Settings& settings,
                StageTimes& times) {
  geometry::check_control_mesh(control);
  tensegric::Model model = [&] {
    const Stopwatch watch(times.tensegric);
    return tensegric::build_model(control, settings.model);
  }();
  const Stopwatch watch(times.tffd);
  const geometry::BoneFrames& bones = settings.solver.bones;
  tffd::Binding binding(body.mesh.mesh, control, settings.tffd);
  auto carried = tffd::carried_triangles(binding, body.mesh.mesh.triangles, control);
  std::vector<tensegric::PosedVolume> volumes;
  if (settings.solver.volume == tensegric::KeptVolume::body)
    volumes = body_volumes(binding, carried, control, bones);
  if (!bones.still()) binding = binding.posed(bones);
  Fitting fitting{std::move(control), std::move(model), std::move(binding), std::move(carried),
                  std::move(volumes)};
  return fitting;
}

std::vector<geometry::LaidLine> laid_lines(const Body& body, const Fitting& fitting,
                                           const tensegric::Garment& garment) {
  std::vector<geometry::LaidLine> laid;
  for (const tensegric::GarmentLine& line : garment.lines) {
    if (!line.on_body()) continue;
    laid.push_back({line.name, lay(line, on_body(fitting.control, line), body.mesh.mesh, fitting.binding)});
  }
  return laid;
}

Fit wear(const Body& body, const Fitting& fitting, const tensegric::Garment& garment,
         const Settings& settings, StageTimes& times, const tensegric::Solution* start) {
  Fit fit;
  std::vector<geometry::LaidLine> laid;
  {
    const Stopwatch watch(times.tffd);
    laid = laid_lines(body, fitting, garment);
  }
  {
    const Stopwatch watch(times.tensegric);
    fit.solution = tensegric::solve(
        fitting.model, garment, settings.solver, start, {}, fitting.body_volumes, laid,
        [&](const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner) {
          return skin_folds(fitting.binding, body.mesh.mesh.triangles, outer, inner);
        });
  }
  const Stopwatch watch(times.tffd);
  fit.deformed = fitting.binding.deform(fit.solution.outer, fit.solution.inner);
  fit.bones = settings.solver.bones;
  fit.distortion =
      tffd::body_distortion(fitting.binding, tffd::control_distortion(fitting.binding, fit.solution.outer));
  for (std::size_t r = 0; r < fitting.carried.size(); ++r) {
    const Eigen::Vector3d apex = geometry::region_apex(fitting.control, fitting.control.regions[r]);
    fit.body_volumes_before.push_back(
        geometry::cone_volume(body.mesh.mesh.vertices, fitting.carried[r], apex));
    fit.body_volumes_after.push_back(
        geometry::cone_volume(fit.deformed, fitting.carried[r], settings.solver.bones.moved(apex)));
  }
  return fit;
}

std::vector<geometry::FitWarning> warnings_of(const Body& body, const Fitting& fitting, const Fit& fit,
                                              const Settings& settings) {
  std::vector<tffd::WornLine> lines;
  for (const tensegric::LineResult& line : fit.solution.lines)
    lines.push_back({line.name, line.course_at_rest, line.course, line.neutral, line.final, line.tension});
  const geometry::TriangleMesh& mesh = body.mesh.mesh;
  return tffd::check_garment({mesh.vertices, body.mesh.filled},
                             {fitting.binding.vertices(), fit.deformed, mesh.triangles}, lines,
                             settings.hold);
}

}  // namespace tensegric_fit::fit
