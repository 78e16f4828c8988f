#include "tensegric/garment_fitter.hpp"

#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

bool GarmentFitter::knows(const std::string& scan_id) const {
  const auto known = wearer();
  return known && known->scan_id == scan_id;
}

void GarmentFitter::check(const Garment& garment, const std::string& scan_id) const {
  SolverOptions options = options_.solver;
  options.volume = KeptVolume::control;  // which volume is kept makes no garment good or bad
  if (const auto known = wearer(); known && known->scan_id == scan_id)
    lay_garment(known->model, garment, options, {}, known->body->lay(garment));
}

std::optional<Solution> GarmentFitter::fit(const Garment& garment, SolverName solver, int rest,
                                           const Progress& progress) {
  const auto now = wearer();
  SolverOptions options = options_.solver;
  options.bones = bones_;
  options.solver = solver;
  const bool warm = last_ && last_rest_ == rest && last_->status == Status::converged;
  SkinFolds folds;
  if (knows_skin_)
    folds = [&now](const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner) {
      return now->body->folds(outer, inner);
    };
  bool stopped = false;
  Solution solution = solve(
      now->model, garment, options, warm ? &*last_ : nullptr,
      [&](const Iterate& iterate, const std::vector<Eigen::Vector3d>& outer,
          const std::vector<Eigen::Vector3d>& inner) {
        stopped = !progress(iterate, outer, inner);
        return !stopped;
      },
      body_volumes_, now->body->lay(garment), folds);
  if (stopped) return std::nullopt;
  last_ = std::move(solution);
  last_rest_ = rest;
  return last_;
}

std::shared_ptr<const Model> GarmentFitter::model() const {
  const auto known = wearer();
  return {known, known ? &known->model : nullptr};
}

std::shared_ptr<const GarmentFitter::Wearer> GarmentFitter::wearer() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return wearer_;
}

void GarmentFitter::take(const std::string& scan_id, const geometry::ControlMesh& control,
                         const geometry::BodyMeasures* measures,
                         std::function<geometry::TriangleMesh()> body) {
  const geometry::BoneFrames bones =
      measures ? geometry::BoneFrames(*measures, options_.posture) : geometry::BoneFrames();
  const bool knows_skin = static_cast<bool>(body);
  const std::shared_ptr<const Wearer> wearer(
      new Wearer{scan_id, build_model(control, options_.model),
                 bind_body_(std::move(body), control, bones, options_.beta)});
  const bool keeps_body = options_.solver.volume == KeptVolume::body;
  std::vector<PosedVolume> body_volumes;
  if (keeps_body) body_volumes = wearer->body->volumes();
  // A refusal leaves everything as it was: from here on there is none.
  bones_ = bones;
  body_volumes_ = std::move(body_volumes);
  knows_skin_ = knows_skin;
  last_.reset();
  std::lock_guard<std::mutex> lock(mutex_);
  wearer_ = wearer;
}

}  // namespace tensegric_fit::tensegric
