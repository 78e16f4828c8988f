#include "tensegric/coarse_fitter.hpp"

#include <utility>

namespace tensegric_fit::tensegric {
namespace {

FitterOptions coarse_options(const FitterOptions& fine) {
  FitterOptions options;
  options.model.stiff_parts = fine.model.stiff_parts;
  options.solver = fine.solver;
  options.posture = fine.posture;
  return options;
}

Iterate state_of(const Solution& solution) {
  Iterate state;
  state.iteration = solution.iterations;
  state.residual = solution.residual;
  for (const LineResult& line : solution.lines) state.line_ratios.push_back(line.final / line.initial);
  for (const RegionResult& region : solution.regions) state.volume_errors.push_back(region.kept_error);
  return state;
}

// So that lines pull with as many newtons on another mesh.
void scale_forces(Garment& garment, double by) {
  for (GarmentLine& line : garment.lines) {
    line.law.stiffness *= by;
    for (auto& row : line.law.table) row.second *= by;
    line.tension_limit *= by;
  }
}

}  // namespace

CoarseFitter::CoarseFitter(const FitterOptions& fine, BindBody bind_body)
    : bind_body_(bind_body),
      posture_(fine.posture),
      beta_(coarse_options(fine).beta),
      fitter_(coarse_options(fine), std::move(bind_body)) {}

void CoarseFitter::take(const geometry::ControlMesh& coarse, const geometry::ControlMesh& fine,
                        const geometry::BodyMeasures* measures,
                        std::function<geometry::TriangleMesh()> body) {
  skin_.reset();
  fitter_.take("", coarse, measures, std::move(body));
  fine_ = fine;
  bones_ = measures ? geometry::BoneFrames(*measures, posture_) : geometry::BoneFrames();
  skin_ = bind_body_([nodes = geometry::TriangleMesh{fine.outer, fine.triangles}] { return nodes; }, coarse,
                     bones_, beta_);
}

std::optional<CoarseFitter::Answer> CoarseFitter::fit(Garment garment, double newtons, SolverName solver,
                                                      int rest, const std::function<bool()>& go_on) {
  if (!skin_) return std::nullopt;
  scale_forces(garment, newtons / fitter_.model()->newtons());
  const auto solution =
      fitter_.fit(garment, solver, rest, [&go_on](const auto&, const auto&, const auto&) { return go_on(); });
  if (!solution || (solution->status != Status::converged && solution->status != Status::infeasible))
    return std::nullopt;
  const std::vector<Eigen::Vector3d> carried = skin_->worn(solution->outer, solution->inner);
  Answer answer{state_of(*solution), {}, {}, static_cast<int>(fitter_.model()->control.triangles.size())};
  // Held nodes stay where bones have them. Inner ones over bone do not move in this tissue.
  for (std::size_t i = 0; i < fine_.outer.size(); ++i) {
    answer.outer.push_back(fine_.outer_fixed[i] ? bones_.moved(fine_.outer[i]) : carried[i]);
    answer.inner.push_back(bones_.moved(fine_.inner[i]));
  }
  return answer;
}

}  // namespace tensegric_fit::tensegric
