#include "tensegric/garment_fitter.hpp"

#include "ros/body_messages.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::node {

void GarmentFitter::check(const tensegric::Garment& garment) const {
  if (const auto known = wearer())
    tensegric::lay_garment(known->model, garment, options_.solver, {}, known->body->lay(garment));
}

tensegric::SolverName GarmentFitter::solver_of(const GarmentRequest& request) const {
  return request.solver.empty() ? options_.solver.solver : tensegric::solver_from(request.solver);
}

std::optional<tensegric::Solution> GarmentFitter::fit(const FittingScene& scene,
                                                      const GarmentRequest& request, int rest,
                                                      const tensegric::Progress& progress) {
  if (scene.control != scene_.control) take(scene);
  const auto now = wearer();
  tensegric::SolverOptions options = options_.solver;
  options.bones = bones_;
  options.solver = solver_of(request);
  const bool warm = last_ && last_rest_ == rest && last_->status == tensegric::Status::converged;
  tensegric::SkinFolds folds;
  if (scene.body)
    folds = [&now](const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner) {
      return now->body->folds(outer, inner);
    };
  bool stopped = false;
  tensegric::Solution solution = tensegric::solve(
      now->model, request.garment, options, warm ? &*last_ : nullptr,
      [&](const tensegric::Iterate& iterate, const std::vector<Eigen::Vector3d>& outer,
          const std::vector<Eigen::Vector3d>& inner) {
        stopped = !progress(iterate, outer, inner);
        return !stopped;
      },
      body_volumes_, now->body->lay(request.garment), folds);
  if (stopped) return std::nullopt;
  last_ = std::move(solution);
  last_rest_ = rest;
  return last_;
}

std::shared_ptr<const tensegric::Model> GarmentFitter::model() const {
  const auto known = wearer();
  return {known, known ? &known->model : nullptr};
}

std::shared_ptr<const GarmentFitter::Wearer> GarmentFitter::wearer() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return wearer_;
}

void GarmentFitter::take(const FittingScene& scene) {
  const geometry::ControlMesh control = control_in(*scene.control);
  bones_ = scene.landmarks ? geometry::BoneFrames(measures_in(*scene.landmarks), options_.posture)
                           : geometry::BoneFrames();
  const std::shared_ptr<const Wearer> wearer(
      new Wearer{tensegric::build_model(control, options_.model),
                 bind_body_([body = scene.body] { return mesh_in(*body); }, control, bones_, options_.beta)});
  const bool keeps_body = options_.solver.volume == tensegric::KeptVolume::body;
  body_volumes_ = keeps_body ? wearer->body->volumes() : std::vector<tensegric::VolumeFunction>();
  scene_ = scene;
  last_.reset();
  std::lock_guard<std::mutex> lock(mutex_);
  wearer_ = wearer;
}

}  // namespace tensegric_fit::node
