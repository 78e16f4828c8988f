#include "calibration/calibration.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/status.hpp"

namespace tensegric_fit::calibration {
namespace {

using fit::Fit;
using fit::Fitting;
using fit::Settings;
using geometry::Refusal;
namespace refusal = geometry::refusal;

constexpr double kStep =
    0.02;  // of a parameter's logarithm, for differences: well above the control mesh's own noise
constexpr double kAtBound = 0.01;  // of the logarithm
constexpr std::size_t kFewestBodies = 3;
constexpr double kLeastWay = 1e-4;  // m, root mean square: less tells nothing

// Fitted by its logarithm. The bounds are where a parameter stops to matter, or the model to stand.
struct Parameter {
  const char* name;
  double& (*of)(Settings&);
  double low, high;
};
constexpr std::array<Parameter, 6> kParameters = {{
    {"strut_stiffness", [](Settings& s) -> double& { return s.model.strut_stiffness; }, 0.02, 200},
    {"lateral_stiffness", [](Settings& s) -> double& { return s.model.lateral_stiffness; }, 0.005, 50},
    {"skin", [](Settings& s) -> double& { return s.model.skin; }, 1e-3, 1},
    {"volume_stiffness", [](Settings& s) -> double& { return s.model.volume_stiffness; }, 0.02, 200},
    {"prestress", [](Settings& s) -> double& { return s.model.prestress; }, 1e-3, 0.5},
    {"thickness", [](Settings& s) -> double& { return s.control_mesh.thickness; }, 0.2, 3},
}};

std::vector<Parameter> parameters_named(const std::vector<std::string>& names) {
  std::vector<Parameter> parameters;
  for (const std::string& name : names) {
    const auto at = std::find_if(kParameters.begin(), kParameters.end(),
                                 [&name](const Parameter& p) { return p.name == name; });
    if (at == kParameters.end()) throw Refusal(refusal::kBadOption, "'" + name + "' cannot be calibrated");
    parameters.push_back(*at);
  }
  return parameters;
}

// Of one body; nothing where a case did not settle.
std::vector<CaseOutcome> settled_cases(const CalibrationBody& body,
                                       const std::vector<control_mesh::Template>& patterns,
                                       const Settings& settings) {
  try {
    std::vector<CaseOutcome> outcomes = wear_cases(body, patterns, settings, true);
    for (const CaseOutcome& outcome : outcomes)
      if (outcome.status != tensegric::Status::converged) return {};
    return outcomes;
  } catch (const Refusal&) {
    return {};  // no prestress, a folded unit: this way leads nowhere
  }
}

std::vector<control_mesh::Template> patterns_of(const tensegric::Garment& garment,
                                                const std::vector<control_mesh::Template>& patterns) {
  std::vector<control_mesh::Template> worn;
  for (const std::string& region : garment.regions) {
    const auto at = std::find_if(patterns.begin(), patterns.end(),
                                 [&region](const control_mesh::Template& p) { return p.name == region; });
    if (at == patterns.end())
      throw Refusal(refusal::kBadGarment, "garment " + garment.name + " is for region '" + region +
                                              "', which has no template here");
    worn.push_back(*at);
  }
  return worn;
}

// Distances to the reference, relative to not moving, of the cases of several bodies.
class TissueCost : public ceres::CostFunction {
 public:
  TissueCost(std::vector<const CalibrationBody*> bodies, const std::vector<control_mesh::Template>& patterns,
             const Settings& start, const std::vector<Parameter>& parameters)
      : bodies_(std::move(bodies)), patterns_(patterns), start_(start), parameters_(parameters) {
    int count = 0;
    for (const CalibrationBody* body : bodies_)
      for (const CalibrationCase& c : body->cases) count += 3 * static_cast<int>(c.reference.vertices.size());
    set_num_residuals(count);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters.size()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    std::vector<double> at(x[0], x[0] + parameters_.size());
    if (!fill(at, residuals)) return false;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    std::vector<double> beside(num_residuals());
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      double step = kStep;
      for (int tries = 0;; ++tries, step = -step) {
        std::vector<double> there = at;
        there[p] += step;
        if (fill(there, beside.data())) break;
        if (tries == 1) return false;
      }
      for (int i = 0; i < num_residuals(); ++i)
        jacobians[0][i * parameters_.size() + p] = (beside[i] - residuals[i]) / step;
    }
    return true;
  }

  Settings settings_at(const std::vector<double>& logarithms) const {
    Settings settings = start_;
    for (std::size_t p = 0; p < parameters_.size(); ++p)
      parameters_[p].of(settings) = std::exp(logarithms[p]);
    return settings;
  }

 private:
  bool fill(const std::vector<double>& at, double* residuals) const {
    const Settings settings = settings_at(at);
    for (const CalibrationBody* body : bodies_) {
      const std::vector<CaseOutcome> outcomes = settled_cases(*body, patterns_, settings);
      if (outcomes.empty()) return false;
      for (std::size_t c = 0; c < outcomes.size(); ++c) {
        const ReferenceField& reference = body->cases[c].reference;
        const double scale =
            1 / (not_moving(reference) * std::sqrt(static_cast<double>(reference.vertices.size())));
        for (std::size_t i = 0; i < reference.vertices.size(); ++i) {
          const int v = reference.vertices[i];
          const Eigen::Vector3d off = scale * (outcomes[c].deformed[v] - body->body.mesh.mesh.vertices[v] -
                                               reference.displacements[i]);
          for (int k = 0; k < 3; ++k) *residuals++ = off[k];
        }
      }
    }
    return true;
  }

  std::vector<const CalibrationBody*> bodies_;
  const std::vector<control_mesh::Template>& patterns_;
  Settings start_;
  std::vector<Parameter> parameters_;
};

Settings fitted_on(std::vector<const CalibrationBody*> bodies,
                   const std::vector<control_mesh::Template>& patterns, const Settings& start,
                   const CalibrationOptions& options) {
  const std::vector<Parameter> parameters = parameters_named(options.fitted);
  Settings from = start;
  std::vector<double> at;
  for (const Parameter& p : parameters)
    at.push_back(std::log(std::clamp(p.of(from), p.low * 1.05, p.high / 1.05)));
  TissueCost cost(std::move(bodies), patterns, start, parameters);
  ceres::Problem::Options owned_here;
  owned_here.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(owned_here);
  problem.AddResidualBlock(&cost, nullptr, at.data());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    problem.SetParameterLowerBound(at.data(), static_cast<int>(p), std::log(parameters[p].low));
    problem.SetParameterUpperBound(at.data(), static_cast<int>(p), std::log(parameters[p].high));
  }
  ceres::Solver::Options how;
  how.linear_solver_type = ceres::DENSE_QR;
  how.max_num_iterations = options.most_iterations;
  how.function_tolerance = 1e-4;
  how.initial_trust_region_radius = 1;
  how.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE)
    throw Refusal(refusal::kNotSettled,
                  "a body did not settle from the first parameters on: " + summary.message);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (at[p] < std::log(parameters[p].low) + kAtBound || at[p] > std::log(parameters[p].high) - kAtBound)
      throw Refusal(refusal::kAtBound,
                    fmt::format("{} ran into its bound at {:.3g}: the references do not tell it",
                                parameters[p].name, std::exp(at[p])));
  return cost.settings_at(at);
}

}  // namespace

double not_moving(const ReferenceField& reference) {
  double sum = 0;
  for (const Eigen::Vector3d& d : reference.displacements) sum += d.squaredNorm();
  return std::sqrt(sum / static_cast<double>(reference.displacements.size()));
}

std::vector<CaseOutcome> wear_cases(const CalibrationBody& body,
                                    const std::vector<control_mesh::Template>& patterns,
                                    const Settings& settings, bool warm) {
  std::map<std::vector<std::string>, Fitting> fittings;  // by regions
  std::vector<CaseOutcome> outcomes;
  Fit last;
  for (std::size_t i = 0; i < body.cases.size(); ++i) {
    const CalibrationCase& c = body.cases[i];
    fit::StageTimes times;
    auto fitting = fittings.find(c.garment.regions);
    if (fitting == fittings.end())
      fitting = fittings
                    .emplace(c.garment.regions,
                             prepare(body.body, patterns_of(c.garment, patterns), settings, times))
                    .first;
    times = {};
    const bool follows = warm && i > 0 && body.cases[i - 1].garment.name == c.garment.name &&
                         body.cases[i - 1].garment.regions == c.garment.regions;
    last = wear(body.body, fitting->second, c.garment, settings, times, follows ? &last.solution : nullptr);
    CaseOutcome outcome{tissue_error(c.reference, body.body.mesh.mesh, last.deformed),
                        last.solution.status,
                        last.solution.iterations,
                        times.tensegric,
                        {},
                        last.deformed};
    for (const tensegric::LineResult& line : last.solution.lines) outcome.tensions.push_back(line.tension);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

Calibration calibrate(const std::vector<CalibrationBody>& bodies,
                      const std::vector<control_mesh::Template>& patterns, const Settings& start,
                      const CalibrationOptions& options, const std::function<void(const std::string&)>& say) {
  if (bodies.size() < kFewestBodies)
    throw Refusal(refusal::kTooFewData,
                  fmt::format("{} bodies: {} are the fewest of which one can be left out", bodies.size(),
                              kFewestBodies));
  for (const CalibrationBody& body : bodies)
    for (const CalibrationCase& c : body.cases)
      if (!(not_moving(c.reference) >= kLeastWay))
        throw Refusal(refusal::kTooFewData, body.name + ", " + c.name + ": the reference does not move");
  const auto errors_of = [&patterns](const CalibrationBody& body, const Settings& settings) {
    std::vector<double> errors(body.cases.size(), std::numeric_limits<double>::quiet_NaN());
    const std::vector<CaseOutcome> outcomes = settled_cases(body, patterns, settings);
    for (std::size_t c = 0; c < outcomes.size(); ++c) errors[c] = outcomes[c].error;
    return errors;
  };
  Calibration result;
  std::vector<const CalibrationBody*> all;
  for (const CalibrationBody& body : bodies) all.push_back(&body);
  say("fitting on all bodies");
  result.settings = fitted_on(all, patterns, start, options);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    say("leaving out " + bodies[b].name);
    std::vector<const CalibrationBody*> others = all;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(b));
    result.left_out.push_back(fitted_on(others, patterns, start, options));
    const auto before = errors_of(bodies[b], start), in = errors_of(bodies[b], result.settings),
               out = errors_of(bodies[b], result.left_out.back());
    for (std::size_t c = 0; c < bodies[b].cases.size(); ++c)
      result.errors.push_back(
          {bodies[b].cases[c].name, not_moving(bodies[b].cases[c].reference), before[c], in[c], out[c]});
  }
  return result;
}

}  // namespace tensegric_fit::calibration
