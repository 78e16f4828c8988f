#include "tensegric/problem.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

void check_regions(const geometry::ControlMesh& control, const Garment& garment) {
  for (const std::string& name : garment.regions) {
    const bool known =
        std::any_of(control.regions.begin(), control.regions.end(),
                    [&name](const geometry::ControlRegion& region) { return region.name == name; });
    if (!known)
      throw Refusal(refusal::kBadGarment, "garment " + garment.name + " is for region '" + name +
                                              "', which the control mesh does not have");
  }
}

void check_options(const geometry::ControlMesh& control, const SolverOptions& options) {
  if (!options.gravity.allFinite()) throw Refusal(refusal::kBadOption, "gravity is not finite");
  if (options.max_iterations < 0) throw Refusal(refusal::kBadOption, "max_iterations is negative");
  for (double force : {options.line_force, options.volume_force})
    if (!(force >= 0 && force <= 1e6))
      throw Refusal(refusal::kBadOption, "line_force and volume_force must be in [0, 1000000]");
  for (int node : options.track)
    if (node < 0 || node >= static_cast<int>(control.outer.size()))
      throw Refusal(refusal::kBadOption, "a tracked node is not one of the control mesh");
}

}  // namespace

Problem lay_garment(const Model& model, const Garment& garment, const SolverOptions& options) {
  check_regions(model.control, garment);
  check_options(model.control, options);
  Problem problem{model,
                  options,
                  model.free_index(),
                  model.free_nodes(),
                  model.rest_positions(),
                  lay_bands(model, garment),
                  {},
                  {},
                  model.mean_tension()};
  problem.units = unit_volumes(model, problem.free_index);
  for (const geometry::ControlRegion& region : model.control.regions)
    problem.volumes.push_back(region_volume_of(model, region));
  return problem;
}

Positions positions_of(const Solution& solution) {
  Positions x = solution.outer;
  x.insert(x.end(), solution.inner.begin(), solution.inner.end());
  return x;
}

double relative_residual(const Problem& problem, const Eigen::VectorXd& gradient) {
  double largest = 0;
  for (int i = 0; i < problem.free_nodes; ++i)
    largest = std::max(largest, gradient.segment<3>(3 * i).squaredNorm());
  return std::sqrt(largest) / problem.force_scale;
}

bool Recorder::record(int iteration, const Positions& x, double residual) {
  Iterate iterate;
  iterate.iteration = iteration;
  for (const Band& band : problem_.bands)
    iterate.line_ratios.push_back(geometry::line_length(band.nodes, x) / band.initial);
  for (const RegionVolume& region : problem_.volumes)
    iterate.volume_errors.push_back(volume_error(region, x));
  for (int node : problem_.options.track) iterate.tracked.push_back(x[node]);
  iterate.residual = residual;
  history.push_back(iterate);
  if (!progress_) return true;
  return progress_(iterate,
                   {x.begin(), x.begin() + static_cast<std::ptrdiff_t>(problem_.model.control.outer.size())});
}

}  // namespace tensegric_fit::tensegric
