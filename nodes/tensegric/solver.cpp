#include "tensegric/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "tensegric/band_length.hpp"
#include "tensegric/band_pressure.hpp"
#include "tensegric/equilibrium.hpp"
#include "tensegric/near_origin.hpp"
#include "tensegric/newton.hpp"
#include "tensegric/problem.hpp"
#include "tensegric/relaxation.hpp"
#include "tensegric/shape_check.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

void check_start(const Model& model, const Solution& start) {
  const std::size_t count = model.control.outer.size();
  if (start.outer.size() != count || start.inner.size() != count ||
      positions_of(start).size() != static_cast<std::size_t>(model.nodes()))
    throw Refusal(refusal::kBadOption, "the solution to start from is not of this model");
  for (const Eigen::Vector3d& p : positions_of(start))
    if (!p.allFinite()) throw Refusal(refusal::kBadOption, "the solution to start from is not finite");
}

void add_sentence(std::string& note, const std::string& sentence) {
  if (!sentence.empty()) note += (note.empty() ? "" : " ") + sentence;
}

// Relative, of a neutral length: far above what makes a line true to its polyline (LoadPath::make_true).
constexpr double kOnTheWay = 1e-4;

std::string millimetres(double metres, int digits = 0) {
  return fmt::format("{:.{}f} mm", 1000 * metres, digits);
}

// Lines that stayed longer than asked for, and why where it is plain. `neutral`: as in an Outcome.
std::string reach_note(const std::vector<LineResult>& lines, const Problem& problem,
                       const std::vector<double>& neutral) {
  const bool is_equilibrium = problem.options.solver == SolverName::equilibrium;
  std::string note;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineResult& line = lines[i];
    if (problem.bands[i].law.kind != TensionLaw::Kind::rigid) {
      const double limit = is_equilibrium ? hold_limit(problem, problem.bands[i]) : line.tension_limit;
      if (line.tension >= limit * (1 - 1e-9))
        add_sentence(note, "Line " + line.name + " pulls as hard as " +
                               (std::isinf(line.tension_limit)
                                    ? "the solver lets a line pull that has no tension_limit."
                                    : "its tension_limit lets it."));
      // An elastic one pulls by how long it is beyond its neutral length: of a shape on the way not by the
      // asked one.
      if (!neutral.empty() && line.tension > 0 && std::abs(neutral[i] / line.neutral - 1) > kOnTheWay)
        add_sentence(note, "Line " + line.name + " pulls as one with a neutral length of " +
                               millimetres(neutral[i]) + "; " + millimetres(line.neutral) +
                               " were asked for.");
      continue;
    }
    if (line.final <= line.neutral * (1 + 1e-6)) continue;
    int digits = 0;  // as many as it takes
    while (digits < 4 && millimetres(line.final, digits) == millimetres(line.neutral, digits)) ++digits;
    add_sentence(note, "Line " + line.name + " is " + millimetres(line.final, digits) + " long; " +
                           millimetres(line.neutral, digits) + " were asked for.");
    if (line.neutral < line.straight)
      add_sentence(note, "It is " + millimetres(line.straight) +
                             " straight from one fixed node to the next: no pull makes it shorter.");
  }
  return note;
}

// A patch that fixed nodes hold in its posture: none of its triangles turns over but by folding. Free shapes
// may bend as far round as they like.
bool held(const Problem& problem) {
  const auto& fixed = problem.model.control.outer_fixed;
  return problem.options.bones.still() && std::count(fixed.begin(), fixed.end(), 0) > 0 &&
         std::count(fixed.begin(), fixed.end(), 1) > 0;
}

std::vector<Eigen::Vector3d> rest_of(const Thread& thread) {
  std::vector<Eigen::Vector3d> points;
  for (const geometry::CarriedPoint& point : thread.points) points.push_back(point.rest);
  return points;
}

Solution report(const Problem& problem, const Outcome& outcome, std::vector<Iterate> history) {
  const Positions& x = outcome.state.x;
  Solution solution;
  put_positions(x, problem.model, solution);
  for (std::size_t b = 0; b < problem.bands.size(); ++b) {
    const Band& band = problem.bands[b];
    const Thread& thread = band.threads[band.threads.size() / 2];
    LineResult line;
    line.name = band.name;
    line.initial = band.initial;
    line.neutral = band.neutral;
    line.final = line.reachable = length_of(band, x);
    line.request = band.request;
    line.tension = outcome.state.tensions[b];
    line.newtons = line.tension * problem.model.newtons();
    line.pressure = largest_pressure(problem.model, band, x, line.newtons);
    line.law = band.law;
    line.tension_limit = band.tension_limit;
    line.nodes = band.nodes;
    line.course_at_rest = rest_of(thread);
    line.course = points_of(thread, x);
    line.width = band.width;
    line.cup = band.cup;
    for (const Thread& fibre : band.threads) {
      line.fibres_at_rest.push_back(rest_of(fibre));
      line.fibres.push_back(points_of(fibre, x));
    }
    line.straight = band.straight;
    solution.lines.push_back(line);
  }
  for (const RegionVolume& region : problem.volumes) {
    const double after = control_volume(region, x);
    solution.regions.push_back({region.name, region.control_rest, after, control_volume_error(region, after),
                                volume_error(region, x)});
  }
  solution.calibrated = !problem.model.options.uniform && problem.options.solver == SolverName::equilibrium;
  solution.status = outcome.status;
  solution.iterations = outcome.iterations;
  solution.residual = outcome.residual;
  solution.history = std::move(history);
  solution.note = outcome.note;
  add_sentence(solution.note, reach_note(solution.lines, problem, outcome.neutral));
  add_sentence(solution.note, shape_note(problem.model, x));
  if (solution.status == Status::converged && held(problem) &&
      triangle_change(problem.model, x).turned_over > 0)
    solution.status = Status::infeasible;
  return solution;
}

// The papers' solvers, from where nodes that are not solved for are where they belong.
Outcome relax_from(Problem& problem, const Solution* start, Recorder& recorder) {
  const bool adaptive = problem.options.solver == SolverName::adaptive;
  if (start == nullptr && problem.options.bones.still()) return relax(problem, nullptr, adaptive, recorder);
  pose_problem(problem, 1);
  const Positions target = posed(problem, 1);
  Positions x = start == nullptr ? target : positions_of(*start);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (problem.free_index[i] < 0) x[i] = target[i];
  Solution from = start == nullptr ? Solution() : *start;
  put_positions(x, problem.model, from);
  return relax(problem, &from, adaptive, recorder);
}

// The papers' solvers know no way back to a shape that was smooth.
Outcome relax_and_check(Problem& problem, const Solution* start, Recorder& recorder) {
  Outcome outcome = relax_from(problem, start, recorder);
  if (outcome.status == Status::converged && skin_folds(problem, outcome.state.x)) {
    outcome.status = Status::infeasible;
    outcome.note = kSkinTurnsOver;
  }
  return outcome;
}

// By how much volumes change where the shape rounds on its way back, relative.
double volume_rounding(const Model& model, const Solution& found, const Solution& rounded) {
  double largest = 0;
  for (const geometry::ControlRegion& part : model.control.regions) {
    const RegionVolume region = region_volume_of(model, part);
    const double change =
        control_volume(region, positions_of(rounded)) - control_volume(region, positions_of(found));
    largest = std::max(largest, std::abs(change) / volume_scale(region));
  }
  return largest;
}

// With the nodes where they are.
Solution solve_here(const Model& model, const Garment& garment, const SolverOptions& options,
                    const Solution* start, const Progress& progress,
                    const std::vector<PosedVolume>& body_volumes, const std::vector<geometry::LaidLine>& laid,
                    const SkinFolds& folds) {
  Problem problem = lay_garment(model, garment, options, body_volumes, laid);
  problem.folds = folds;
  Recorder recorder(problem, progress);
  recorder.record(0, start == nullptr ? problem.rest : positions_of(*start),
                  start == nullptr ? 0 : start->residual);
  const Outcome outcome = options.solver == SolverName::equilibrium
                              ? find_equilibrium(problem, start, recorder)
                              : relax_and_check(problem, start, recorder);
  return report(problem, outcome, std::move(recorder.history));
}

}  // namespace

std::string to_string(SolverName name) {
  return kSolverWords.of(name);
}

std::string to_string(Status status) {
  static constexpr geometry::EnumWords<Status, 5> kWords{
      {"converged", "infeasible", "capped", "oscillating", "diverged"}};
  return kWords.of(status);
}

SolverName solver_from(const std::string& word) {
  if (const auto name = kSolverWords.find(word)) return *name;
  throw Refusal(refusal::kBadOption, "solver '" + word + "' is not equilibrium, adaptive or relaxation");
}

Solution solve(const Model& model, const Garment& garment, const SolverOptions& options,
               const Solution* start, const Progress& progress, const std::vector<PosedVolume>& body_volumes,
               const std::vector<geometry::LaidLine>& laid, const SkinFolds& folds) {
  if (start != nullptr) check_start(model, *start);
  const Eigen::Vector3d by = offset_to_origin(model.control);
  if (by.isZero(0)) return solve_here(model, garment, options, start, progress, body_volumes, laid, folds);
  SolverOptions near = options;
  near.bones = moved(options.bones, by);
  Solution from;
  if (start != nullptr) from = moved(*start, by);
  const Model model_near = moved(model, by);
  const Solution found =
      solve_here(model_near, garment, near, start == nullptr ? nullptr : &from, seen_from_scan(progress, by),
                 seen_from_scan(body_volumes, by), moved(laid, by), seen_from_scan(folds, by));
  const Solution there = moved(found, -by);
  if (volume_rounding(model_near, found, moved(there, by)) <= kWanted.volume) return there;
  // Coordinates there are too coarse for a shape as small: what can be had of it is found among them.
  return solve_here(model, garment, options, start, progress, body_volumes, laid, folds);
}

}  // namespace tensegric_fit::tensegric
