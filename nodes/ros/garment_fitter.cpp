#include "ros/garment_fitter.hpp"

#include "ros/body_messages.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::node {

GarmentFitter::GarmentFitter(const tensegric::ModelOptions& model, const tensegric::SolverOptions& solver)
    : model_options_(model), solver_options_(solver) {}

void GarmentFitter::check(const tensegric::Garment& garment) const {
  if (const auto known = model()) tensegric::lay_garment(*known, garment, solver_options_);
}

tensegric::SolverName GarmentFitter::solver_of(const GarmentRequest& request) const {
  return request.solver.empty() ? solver_options_.solver : tensegric::solver_from(request.solver);
}

std::optional<tensegric::Solution> GarmentFitter::fit(const ControlMesh::ConstPtr& control,
                                                      const GarmentRequest& request, bool from_rest,
                                                      const tensegric::Progress& progress) {
  if (control != control_) take(control);
  tensegric::SolverOptions options = solver_options_;
  options.solver = solver_of(request);
  const bool warm = !from_rest && last_ && last_->status == tensegric::Status::converged;
  bool stopped = false;
  tensegric::Solution solution =
      tensegric::solve(*model(), request.garment, options, warm ? &*last_ : nullptr,
                       [&](const tensegric::Iterate& iterate, const std::vector<Eigen::Vector3d>& outer) {
                         stopped = !progress(iterate, outer);
                         return !stopped;
                       });
  if (stopped) return std::nullopt;
  last_ = std::move(solution);
  return last_;
}

std::shared_ptr<const tensegric::Model> GarmentFitter::model() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return model_;
}

void GarmentFitter::take(const ControlMesh::ConstPtr& control) {
  auto model =
      std::make_shared<const tensegric::Model>(tensegric::build_model(control_in(*control), model_options_));
  control_ = control;
  last_.reset();
  std::lock_guard<std::mutex> lock(mutex_);
  model_ = std::move(model);
}

}  // namespace tensegric_fit::node
