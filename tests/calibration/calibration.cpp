#include "calibration/calibration.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "geometry/parallel_for.hpp"
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
constexpr double kLeastWay = 1e-4;  // m, root mean square: the references repeat to 0.08 mm

// Fitted by its logarithm. The bounds are where a parameter stops to matter, or the model to stand.
struct Parameter {
  const char* name;
  double& (*of)(Adjusted&);
  double low, high;
};
constexpr std::array<Parameter, 10> kParameters = {{
    {"strut_stiffness", [](Adjusted& a) -> double& { return a.settings.model.strut_stiffness; }, 0.02, 200},
    {"lateral_stiffness", [](Adjusted& a) -> double& { return a.settings.model.lateral_stiffness; }, 0.005,
     50},
    {"skin", [](Adjusted& a) -> double& { return a.settings.model.skin; }, 1e-3, 1},
    {"volume_stiffness", [](Adjusted& a) -> double& { return a.settings.model.volume_stiffness; }, 0.02, 200},
    {"shear_stiffness", [](Adjusted& a) -> double& { return a.settings.model.shear_stiffness; }, 1e-3, 20},
    {"stiffening", [](Adjusted& a) -> double& { return a.settings.model.stiffening; }, 0.1, 1e3},
    {"modulus", [](Adjusted& a) -> double& { return a.settings.model.modulus; }, 10, 1e6},
    {"prestress", [](Adjusted& a) -> double& { return a.settings.model.prestress; }, 1e-3, 0.5},
    {"thickness", [](Adjusted& a) -> double& { return a.settings.control_mesh.thickness; }, 0.2, 3},
    {"pull", [](Adjusted& a) -> double& { return a.pull; }, 0.1, 5},
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

tensegric::Garment pulled(tensegric::Garment garment, double pull) {
  for (tensegric::GarmentLine& line : garment.lines)
    line.ratio = std::max(1 - pull * (1 - line.ratio), tensegric::kRatio.low);
  return garment;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

Settings settings_for(const CalibrationBody& body, Settings settings) {
  if (!body.fineness) return settings;
  settings.control_mesh.control_triangles = body.fineness->control_triangles;
  settings.model.layers = body.fineness->layers;
  return settings;
}

// A body with what the tissue's stiffnesses do not touch: control meshes, bindings, laid lines.
class Prepared {
 public:
  Prepared(const CalibrationBody& body, const std::vector<control_mesh::Template>& patterns,
           const Settings& settings)
      : body_(body), thickness_(settings.control_mesh.thickness) {
    fit::StageTimes times;
    for (const CalibrationCase& c : body.cases) {
      auto fitting = fittings_.find(c.garment.regions);
      if (fitting == fittings_.end())
        fitting = fittings_
                      .emplace(c.garment.regions, prepare(body.body, patterns_of(c.garment, patterns),
                                                          settings_for(body, settings), times))
                      .first;
      fitting_.push_back(&fitting->second);
      laid_.push_back(fit::laid_lines(body.body, fitting->second, c.garment));
    }
  }
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  double thickness() const { return thickness_; }

  std::vector<CaseOutcome> outcomes(const Adjusted& adjusted, bool warm) const {
    const Settings& settings = adjusted.settings;
    std::map<const Fitting*, tensegric::Model> models;
    for (const auto& [regions, fitting] : fittings_)
      models.emplace(&fitting, tensegric::build_model(fitting.control, settings_for(body_, settings).model));
    std::vector<CaseOutcome> outcomes;
    tensegric::Solution last;
    for (std::size_t i = 0; i < body_.cases.size(); ++i) {
      const CalibrationCase& c = body_.cases[i];
      const bool follows = warm && i > 0 && body_.cases[i - 1].garment.name == c.garment.name &&
                           fitting_[i - 1] == fitting_[i];
      const auto start = std::chrono::steady_clock::now();
      last = tensegric::solve(models.at(fitting_[i]), pulled(c.garment, adjusted.pull), settings.solver,
                              follows ? &last : nullptr, {}, fitting_[i]->body_volumes, laid_[i]);
      CaseOutcome outcome{0, last.status, last.iterations, milliseconds_since(start), {}, {}};
      outcome.deformed = fitting_[i]->binding.deform(last.outer, last.inner);
      outcome.error = c.worn ? root_mean_square(c.worn->distances(body_.body, outcome.deformed))
                             : tissue_error(c.reference, body_.body.mesh.mesh, outcome.deformed);
      for (const tensegric::LineResult& line : last.lines) outcome.tensions.push_back(line.newtons);
      outcomes.push_back(std::move(outcome));
    }
    return outcomes;
  }

 private:
  static double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  const CalibrationBody& body_;
  double thickness_;
  std::map<std::vector<std::string>, Fitting> fittings_;  // by regions
  std::vector<const Fitting*> fitting_;                   // of each case
  std::vector<std::vector<geometry::LaidLine>> laid_;     // of each case
};

// All bodies, each prepared anew only where its inner nodes lie elsewhere.
class Wardrobe {
 public:
  Wardrobe(const std::vector<CalibrationBody>& bodies, const std::vector<control_mesh::Template>& patterns)
      : bodies_(bodies), patterns_(patterns), kept_(bodies.size()) {}

  // Of one body; nothing where a case did not settle.
  std::vector<CaseOutcome> settled(const CalibrationBody& body, const Adjusted& adjusted) {
    try {
      std::vector<CaseOutcome> outcomes = prepared(body, adjusted.settings).outcomes(adjusted, true);
      for (const CaseOutcome& outcome : outcomes)
        if (outcome.status != tensegric::Status::converged) return {};
      return outcomes;
    } catch (const Refusal&) {
      return {};  // no prestress, a folded unit: this way leads nowhere
    }
  }

 private:
  const Prepared& prepared(const CalibrationBody& body, const Settings& settings) {
    auto& kept = kept_[&body - bodies_.data()];
    for (const auto& one : kept)
      if (one->thickness() == settings.control_mesh.thickness) return *one;
    if (kept.size() == kMostKept) kept.erase(kept.begin());
    kept.push_back(std::make_unique<Prepared>(body, patterns_, settings));
    return *kept.back();
  }

  static constexpr std::size_t kMostKept = 3;  // memory: a binding each
  const std::vector<CalibrationBody>& bodies_;
  const std::vector<control_mesh::Template>& patterns_;
  std::vector<std::vector<std::unique_ptr<Prepared>>> kept_;
};

// Of one body: distances to the reference relative to not moving, and the logarithms of the tensions over
// the reference's.
Eigen::VectorXd residuals_of(const CalibrationBody& body, const std::vector<CaseOutcome>& outcomes) {
  std::vector<double> residuals;
  for (std::size_t c = 0; c < outcomes.size(); ++c) {
    const CalibrationCase& one = body.cases[c];
    if (one.worn) {
      const std::vector<double> distances = one.worn->distances(body.body, outcomes[c].deformed);
      for (const double distance : distances)
        residuals.push_back(distance / (one.still * std::sqrt(static_cast<double>(distances.size()))));
      continue;
    }
    const ReferenceField& reference = one.reference;
    const double scale = 1 / (one.still * std::sqrt(static_cast<double>(reference.vertices.size())));
    for (std::size_t i = 0; i < reference.vertices.size(); ++i) {
      const int v = reference.vertices[i];
      const Eigen::Vector3d off =
          scale * (outcomes[c].deformed[v] - body.body.mesh.mesh.vertices[v] - reference.displacements[i]);
      residuals.insert(residuals.end(), off.begin(), off.end());
    }
    const std::vector<double>& newtons = body.cases[c].newtons;
    for (std::size_t l = 0; l < newtons.size(); ++l)
      residuals.push_back(std::log(std::max(outcomes[c].tensions[l], kLeastPull) / newtons[l]) /
                          std::sqrt(static_cast<double>(newtons.size())));
  }
  return Eigen::Map<const Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
}

// Residuals of all bodies at some parameters, and their derivatives by these.
class TissueCost : public ceres::CostFunction {
 public:
  TissueCost(const std::vector<CalibrationBody>& bodies, Wardrobe& wardrobe, const Adjusted& start,
             const std::vector<Parameter>& parameters)
      : bodies_(bodies), wardrobe_(wardrobe), start_(start), parameters_(parameters) {
    int count = 0;
    for (const CalibrationBody& body : bodies_)
      for (const CalibrationCase& c : body.cases)
        count += static_cast<int>((c.worn ? c.worn->vertices() : 3 * c.reference.vertices.size()) +
                                  c.newtons.size());
    set_num_residuals(count);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters.size()));
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(x[0], parameters_.size());
    const std::vector<Eigen::VectorXd> here = evaluate(at);
    if (here.empty()) return false;
    for (const Eigen::VectorXd& of_body : here)
      residuals = std::copy(of_body.begin(), of_body.end(), residuals);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    const std::vector<Eigen::MatrixXd> slopes = derivatives(at, here);
    if (slopes.empty()) return false;
    double* row = jacobians[0];
    for (const Eigen::MatrixXd& of_body : slopes)
      for (Eigen::Index i = 0; i < of_body.rows(); ++i)
        for (Eigen::Index p = 0; p < of_body.cols(); ++p) *row++ = of_body(i, p);
    return true;
  }

  // One vector a body; none where a case did not settle.
  std::vector<Eigen::VectorXd> evaluate(const Eigen::VectorXd& at) const {
    const Adjusted adjusted = adjusted_at(at);
    std::vector<Eigen::VectorXd> residuals(bodies_.size());
    geometry::parallel_for(bodies_.size(), [&](std::size_t from, std::size_t to, int) {
      for (std::size_t b = from; b < to; ++b) {
        const std::vector<CaseOutcome> outcomes = wardrobe_.settled(bodies_[b], adjusted);
        if (!outcomes.empty()) residuals[b] = residuals_of(bodies_[b], outcomes);
      }
    });
    for (const Eigen::VectorXd& of_body : residuals)
      if (of_body.size() == 0) return {};
    return residuals;
  }

  std::vector<Eigen::MatrixXd> derivatives(const Eigen::VectorXd& at,
                                           const std::vector<Eigen::VectorXd>& here) const {
    std::vector<Eigen::MatrixXd> slopes;
    for (const Eigen::VectorXd& of_body : here) slopes.emplace_back(of_body.size(), parameters_.size());
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      double step = kStep;
      std::vector<Eigen::VectorXd> beside;
      for (int tries = 0; beside.empty(); ++tries, step = -step) {
        if (tries == 2) return {};
        Eigen::VectorXd there = at;
        there[p] += step;
        beside = evaluate(there);
        if (!beside.empty())
          for (std::size_t b = 0; b < here.size(); ++b)
            slopes[b].col(static_cast<Eigen::Index>(p)) = (beside[b] - here[b]) / step;
      }
    }
    return slopes;
  }

  Adjusted adjusted_at(const Eigen::VectorXd& logarithms) const {
    Adjusted adjusted = start_;
    for (std::size_t p = 0; p < parameters_.size(); ++p)
      parameters_[p].of(adjusted) = std::exp(logarithms[static_cast<Eigen::Index>(p)]);
    return adjusted;
  }

 private:
  const std::vector<CalibrationBody>& bodies_;
  Wardrobe& wardrobe_;
  Adjusted start_;
  std::vector<Parameter> parameters_;
};

// Says each iteration's cost and parameters.
class Progress : public ceres::IterationCallback {
 public:
  Progress(const std::vector<Parameter>& parameters, const Eigen::VectorXd& at,
           const std::function<void(const std::string&)>& say)
      : parameters_(parameters), at_(at), say_(say) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    std::string line = fmt::format("  {}: cost {:.4f}", summary.iteration, summary.cost);
    for (std::size_t p = 0; p < parameters_.size(); ++p)
      line += fmt::format(", {} {:.4g}", parameters_[p].name, std::exp(at_[static_cast<Eigen::Index>(p)]));
    say_(line);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::vector<Parameter>& parameters_;
  const Eigen::VectorXd& at_;
  const std::function<void(const std::string&)>& say_;
};

// The logarithms of the parameters that fit all bodies.
Eigen::VectorXd fitted(TissueCost& cost, const std::vector<Parameter>& parameters, Adjusted start,
                       const CalibrationOptions& options,
                       const std::function<void(const std::string&)>& say) {
  Eigen::VectorXd at(parameters.size());
  for (std::size_t p = 0; p < parameters.size(); ++p)
    at[static_cast<Eigen::Index>(p)] =
        std::log(std::clamp(parameters[p].of(start), parameters[p].low * 1.05, parameters[p].high / 1.05));
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
  how.function_tolerance = 5e-3;  // a quarter per cent of the errors: far below the references' own noise
  how.initial_trust_region_radius = 100;  // the valley of the stiffnesses is long and flat
  how.logging_type = ceres::SILENT;
  Progress progress(parameters, at, say);
  how.callbacks.push_back(&progress);
  how.update_state_every_iteration = true;
  ceres::Solver::Summary summary;
  ceres::Solve(how, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE)
    throw Refusal(refusal::kNotSettled,
                  "a body did not settle from the first parameters on: " + summary.message);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (at[p] < std::log(parameters[p].low) + kAtBound || at[p] > std::log(parameters[p].high) - kAtBound)
      throw Refusal(refusal::kAtBound,
                    fmt::format("{} ran into its bound at {:.3g}: the references do not determine it",
                                parameters[p].name, std::exp(at[p])));
  return at;
}

// What one step of Gauss and Newton makes of the fit on all when a body is taken away: exact where the
// displacements are linear in the parameters' logarithms.
std::vector<Adjusted> left_out(const std::vector<CalibrationBody>& bodies, const TissueCost& cost,
                               const Eigen::VectorXd& at) {
  const std::vector<Eigen::VectorXd> here = cost.evaluate(at);
  const std::vector<Eigen::MatrixXd> slopes = cost.derivatives(at, here);
  std::vector<Adjusted> adjusted;
  for (const CalibrationBody& away : bodies) {
    Eigen::MatrixXd others = Eigen::MatrixXd::Zero(at.size(), at.size());
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(at.size());
    for (std::size_t b = 0; b < slopes.size(); ++b) {
      if (bodies[b].name == away.name) continue;  // of any fineness
      others += slopes[b].transpose() * slopes[b];
      slope += slopes[b].transpose() * here[b];
    }
    adjusted.push_back(cost.adjusted_at(at - others.ldlt().solve(slope)));
  }
  return adjusted;
}

}  // namespace

CalibrationCase displaced_case(std::string name, tensegric::Garment garment, ReferenceField reference,
                               std::vector<double> newtons) {
  double sum = 0;
  for (const Eigen::Vector3d& d : reference.displacements) sum += d.squaredNorm();
  const double still = std::sqrt(sum / static_cast<double>(reference.displacements.size()));
  return {std::move(name), std::move(garment), std::move(reference), std::move(newtons), {}, still};
}

CalibrationCase worn_case(std::string name, tensegric::Garment garment, WornReference worn,
                          const fit::Body& bare) {
  const double still = root_mean_square(worn.distances(bare, bare.mesh.mesh.vertices));
  return {std::move(name), std::move(garment), {}, {}, std::move(worn), still};
}

std::vector<CaseOutcome> wear_cases(const CalibrationBody& body,
                                    const std::vector<control_mesh::Template>& patterns,
                                    const Adjusted& adjusted, bool warm) {
  return Prepared(body, patterns, adjusted.settings).outcomes(adjusted, warm);
}

Calibration calibrate(const std::vector<CalibrationBody>& bodies,
                      const std::vector<control_mesh::Template>& patterns, const Adjusted& start,
                      const CalibrationOptions& options, const std::function<void(const std::string&)>& say) {
  std::set<std::string> names;  // a body is left out at all its meshes
  for (const CalibrationBody& body : bodies) names.insert(body.name);
  if (names.size() < kFewestBodies)
    throw Refusal(refusal::kTooFewData,
                  fmt::format("{} bodies: {} are the fewest of which one can be left out", names.size(),
                              kFewestBodies));
  for (const CalibrationBody& body : bodies)
    for (const CalibrationCase& c : body.cases)
      if (!(c.still >= kLeastWay))
        throw Refusal(refusal::kTooFewData, body.name + ", " + c.name + ": the reference does not move");
  Wardrobe wardrobe(bodies, patterns);
  const auto errors_of = [&wardrobe](const CalibrationBody& body, const Adjusted& adjusted) {
    std::vector<double> errors(body.cases.size(), std::numeric_limits<double>::quiet_NaN());
    const std::vector<CaseOutcome> outcomes = wardrobe.settled(body, adjusted);
    for (std::size_t c = 0; c < outcomes.size(); ++c) errors[c] = outcomes[c].error;
    return errors;
  };
  const std::vector<Parameter> parameters = parameters_named(options.fitted);
  TissueCost cost(bodies, wardrobe, start, parameters);
  say("fitting on all bodies");
  const Eigen::VectorXd at = fitted(cost, parameters, start, options, say);
  Calibration result;
  result.adjusted = cost.adjusted_at(at);
  say("leaving out each body");
  result.left_out = left_out(bodies, cost, at);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto before = errors_of(bodies[b], start), in = errors_of(bodies[b], result.adjusted),
               out = errors_of(bodies[b], result.left_out[b]);
    for (std::size_t c = 0; c < bodies[b].cases.size(); ++c)
      result.errors.push_back({bodies[b].cases[c].name, bodies[b].cases[c].still, before[c], in[c], out[c]});
  }
  return result;
}

std::size_t least_left_out(const std::vector<Calibration>& found) {
  std::optional<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < found.size(); ++i) {
    double error = 0;  // NaN where a case did not settle
    for (const CalibrationError& e : found[i].errors)
      error += e.out_of_sample / e.not_moving / static_cast<double>(found[i].errors.size());
    if (!(error < least)) continue;
    least = error;
    best = i;
  }
  if (!best) throw Refusal(refusal::kNotSettled, "no density settled on each body when it was left out");
  return *best;
}

std::string tissue_yaml(const fit::Settings& settings) {
  const tensegric::ModelOptions& model = settings.model;
  std::string text = fmt::format("inner_nodes: {}\nlayers: {}\nuniform_stiffness: {}\n",
                                 to_string(model.inner), model.layers, model.uniform);
  for (const tensegric::ModelNumber& number : tensegric::kModelNumbers)
    text += fmt::format("{}: {:.4g}\n", number.name, model.*number.field);
  text +=
      fmt::format("thickness: {:.4g}\nbeta: {:.4g}\n", settings.control_mesh.thickness, settings.tffd.beta);
  if (!model.stiff_parts.empty()) text += "stiff_parts:\n";
  for (const tensegric::StiffPart& part : model.stiff_parts) text += fmt::format("  - {}\n", to_string(part));
  return text;
}

}  // namespace tensegric_fit::calibration
