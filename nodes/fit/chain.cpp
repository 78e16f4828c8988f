#include "fit/chain.hpp"

#include <chrono>

#include "tffd/distortion.hpp"

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

// Body triangles that the control mesh can move.
std::vector<Eigen::Vector3i> reached_triangles(const Body& body, const tffd::Binding& binding) {
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector3i& t : body.mesh.mesh.triangles)
    if (binding.reaches(t[0]) || binding.reaches(t[1]) || binding.reaches(t[2])) triangles.push_back(t);
  return triangles;
}

}  // namespace

Body measure_scan(const geometry::PointCloud& scan, const Settings& settings, StageTimes& times) {
  Body body;
  {
    const Stopwatch watch(times.reconstruction);
    body.mesh = reconstruction::reconstruct(scan, settings.reconstruction);
  }
  const Stopwatch watch(times.landmarks);
  body.measures = landmarks::find_landmarks(body.mesh.mesh, body.mesh.filled, settings.landmarks);
  return body;
}

Body measure_mesh(geometry::TriangleMesh mesh, const Settings& settings, StageTimes& times) {
  Body body = take_mesh(std::move(mesh));
  const Stopwatch watch(times.landmarks);
  body.measures = landmarks::find_landmarks(body.mesh.mesh, body.mesh.filled, settings.landmarks);
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
    for (const control_mesh::Template& pattern : patterns)
      parts.push_back(
          control_mesh::fit_template(pattern, body.mesh.mesh, body.measures, settings.control_mesh));
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
  tffd::Binding binding(body.mesh.mesh, control, settings.tffd);
  return {std::move(control), std::move(model), std::move(binding)};
}

Fit wear(const Body& body, const Fitting& fitting, const tensegric::Garment& garment,
         const Settings& settings, StageTimes& times, const tensegric::Solution* start) {
  Fit fit;
  {
    const Stopwatch watch(times.tensegric);
    fit.solution = tensegric::solve(fitting.model, garment, settings.solver, start);
  }
  const Stopwatch watch(times.tffd);
  const geometry::BoneFrames& bones = settings.solver.bones;
  const auto deform = [&](const tffd::Binding& binding) {
    return binding.deform(fit.solution.outer, fit.solution.inner);
  };
  fit.deformed = bones.still() ? deform(fitting.binding) : deform(fitting.binding.posed(bones));
  fit.distortion =
      tffd::body_distortion(fitting.binding, tffd::control_distortion(fitting.control, fit.solution.outer));
  const auto triangles = reached_triangles(body, fitting.binding);
  for (const geometry::ControlRegion& region : fitting.control.regions) {
    const Eigen::Vector3d apex = geometry::region_apex(fitting.control, region);
    fit.body_volumes_before.push_back(geometry::cone_volume(body.mesh.mesh.vertices, triangles, apex));
    fit.body_volumes_after.push_back(geometry::cone_volume(fit.deformed, triangles, bones.moved(apex)));
  }
  return fit;
}

}  // namespace tensegric_fit::fit
