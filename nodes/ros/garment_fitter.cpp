#include "ros/garment_fitter.hpp"

#include "ros/body_messages.hpp"
#include "tensegric/problem.hpp"
#include "tffd/body_volume.hpp"

namespace tensegric_fit::node {

void GarmentFitter::check(const tensegric::Garment& garment) const {
  if (const auto known = model()) tensegric::lay_garment(*known, garment, options_.solver);
}

tensegric::SolverName GarmentFitter::solver_of(const GarmentRequest& request) const {
  return request.solver.empty() ? options_.solver.solver : tensegric::solver_from(request.solver);
}

std::optional<tensegric::Solution> GarmentFitter::fit(const FittingScene& scene,
                                                      const GarmentRequest& request, int rest,
                                                      const tensegric::Progress& progress) {
  if (scene.control != scene_.control) take(scene);
  tensegric::SolverOptions options = options_.solver;
  options.bones = bones_;
  options.solver = solver_of(request);
  const bool warm = last_ && last_rest_ == rest && last_->status == tensegric::Status::converged;
  bool stopped = false;
  tensegric::Solution solution = tensegric::solve(
      *model(), request.garment, options, warm ? &*last_ : nullptr,
      [&](const tensegric::Iterate& iterate, const std::vector<Eigen::Vector3d>& outer,
          const std::vector<Eigen::Vector3d>& inner) {
        stopped = !progress(iterate, outer, inner);
        return !stopped;
      },
      body_volumes_);
  if (stopped) return std::nullopt;
  last_ = std::move(solution);
  last_rest_ = rest;
  return last_;
}

std::shared_ptr<const tensegric::Model> GarmentFitter::model() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return model_;
}

void GarmentFitter::take(const FittingScene& scene) {
  auto model = std::make_shared<const tensegric::Model>(
      tensegric::build_model(control_in(*scene.control), options_.model));
  bones_ = scene.landmarks ? geometry::BoneFrames(measures_in(*scene.landmarks), options_.posture)
                           : geometry::BoneFrames();
  body_volumes_.clear();
  if (scene.body) {
    const geometry::TriangleMesh body = mesh_in(*scene.body);
    const tffd::Binding binding = tffd::Binding(body, model->control, {}).posed(bones_);
    const auto carried = tffd::carried_triangles(binding, body.triangles, model->control);
    for (std::size_t r = 0; r < carried.size(); ++r)
      body_volumes_.push_back(tffd::BodyVolume(
          binding, carried[r], geometry::region_apex(model->control, model->control.regions[r])));
  }
  scene_ = scene;
  last_.reset();
  std::lock_guard<std::mutex> lock(mutex_);
  model_ = std::move(model);
}

}  // namespace tensegric_fit::node
