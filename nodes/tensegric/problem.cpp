#include "tensegric/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "geometry/disjoint_sets.hpp"
#include "geometry/status.hpp"
#include "tensegric/band_length.hpp"
#include "tensegric/course.hpp"

namespace tensegric_fit::tensegric {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

// Of a band without a limit of its own. Round a hip of 0.16 m one of 30 mm would press by 54 kPa with it,
// three times what stops the blood (120 mmHg); taut hips at a request of 0.95 pull a seventh of it. In
// newtons: of a pseudo force there are the fewer the finer the control mesh is.
constexpr double kTightestHold = 260;     // N
constexpr double kTightestUniform = 200;  // pseudo force, of the papers' units, which have no newtons

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
  geometry::check_option("max_iterations", options.max_iterations, kMaxIterations);
  geometry::check_option("time_budget", options.time_budget, kTimeBudget);
  geometry::check_option("line_force", options.line_force, kPseudoForce);
  geometry::check_option("volume_force", options.volume_force, kPseudoForce);
  for (int node : options.track)
    if (node < 0 || node >= static_cast<int>(control.outer.size()))
      throw Refusal(refusal::kBadOption, "a tracked node is not one of the control mesh");
}

void check_body_volumes(const Model& model, const SolverOptions& options,
                        const std::vector<PosedVolume>& body_volumes) {
  if (options.volume == KeptVolume::control) return;
  if (body_volumes.size() != model.control.regions.size() ||
      !std::all_of(body_volumes.begin(), body_volumes.end(),
                   [](const PosedVolume& f) { return f != nullptr; }))
    throw Refusal(refusal::kBadOption,
                  "the body's volume is to be kept, but is not given for each region of the control mesh");
}

void check_body_volume(const RegionVolume& region) {
  if (region.body && !(std::isfinite(region.rest) && std::isfinite(region.area) && region.area > 0))
    throw Refusal(refusal::kBadOption, "the volume of the body under region '" + region.name +
                                           "' does not follow the control mesh");
}

// Gravity and posture.
bool acts_on_all(const SolverOptions& options) {
  return !options.gravity.isZero(0) || !options.bones.still();
}

// Of the pieces of a control mesh, `piece` of each of its outer nodes.
std::vector<int> pieces_under(const Band& band, const std::vector<int>& piece) {
  std::vector<int> under;
  for (const Thread& thread : band.threads)
    for (const geometry::CarriedPoint& point : thread.points)
      for (const auto& [node, weight] : point.weights)
        under.push_back(piece[static_cast<std::size_t>(node) % piece.size()]);
  std::sort(under.begin(), under.end());
  under.erase(std::unique(under.begin(), under.end()), under.end());
  return under;
}

// Of each outer node: is it in a piece of the control mesh that anything acts on?
std::vector<char> touched_nodes(const Problem& problem) {
  const geometry::ControlMesh& control = problem.model.control;
  const bool all = acts_on_all(problem.options);
  std::vector<char> touched(control.outer.size(), all);
  if (all) return touched;
  const std::vector<int> piece = problem.model.piece_of_nodes();
  std::vector<char> piece_touched(control.outer.size(), 0);
  for (const Band& band : problem.bands)
    for (const int under : pieces_under(band, piece)) piece_touched[under] = 1;
  for (std::size_t i = 0; i < touched.size(); ++i) touched[i] = piece_touched[piece[i]];
  return touched;
}

void number_free_nodes(Problem& problem) {
  const std::vector<char> touched = touched_nodes(problem);
  const std::size_t outer = touched.size();
  problem.free_index.assign(problem.rest.size(), -1);
  problem.free_nodes = 0;
  for (std::size_t i = 0; i < problem.free_index.size(); ++i)
    if (touched[i % outer] && !is_held(problem, static_cast<int>(i)))
      problem.free_index[i] = problem.free_nodes++;
}

// What the garment's bands can move, and the volumes that are kept.
void take_tissue(Problem& problem, const std::vector<PosedVolume>& body_volumes) {
  const Model& model = problem.model;
  number_free_nodes(problem);
  problem.units = unit_volumes(model, problem.free_index);
  problem.columns = columns_of(model, problem.free_index);
  problem.shears = unit_shears(model, problem.free_index);
  problem.skin = skin_triangles(model, problem.free_index);
  for (std::size_t r = 0; r < model.control.regions.size(); ++r) {
    const bool body = problem.options.volume == KeptVolume::body;
    problem.volumes.push_back(region_volume_of(model, model.control.regions[r], problem.free_index,
                                               body ? body_volumes[r] : PosedVolume()));
    check_body_volume(problem.volumes.back());
  }
}

}  // namespace

void check_names(const geometry::ControlMesh& control, const Garment& garment) {
  check_regions(control, garment);
  for (const GarmentLine& line : garment.lines)
    if (line.points.empty()) nodes_of(control, line);
}

Problem lay_garment(const Model& model, const Garment& garment, const SolverOptions& options,
                    const std::vector<PosedVolume>& body_volumes,
                    const std::vector<geometry::LaidLine>& laid) {
  check_regions(model.control, garment);
  check_options(model.control, options);
  check_body_volumes(model, options, body_volumes);
  Problem problem{model,
                  options,
                  {},
                  0,
                  model.rest_positions(),
                  lay_bands(model, garment, laid),
                  {},
                  {},
                  {},
                  {},
                  {},
                  model.mean_tension(),
                  {}};
  const Positions at_end = posed(problem, 1);
  for (Band& band : problem.bands) {
    Band carried = band;  // ends that bone holds move with the posture
    pose_band(carried, problem.rest, options.bones, 1);
    band.straight = straight_way(model, carried, at_end);
  }
  take_tissue(problem, body_volumes);
  return problem;
}

std::vector<std::vector<int>> separate_bands(const Problem& problem) {
  std::vector<int> all(problem.bands.size());
  std::iota(all.begin(), all.end(), 0);
  if (acts_on_all(problem.options) || problem.options.volume == KeptVolume::body) return {all};
  const std::vector<int> piece = problem.model.piece_of_nodes();
  geometry::DisjointSets sets(piece.size());
  const auto join = [&sets](const std::vector<int>& pieces) {
    for (const int other : pieces) sets.join(pieces.front(), other);
  };
  for (const RegionVolume& region : problem.volumes) {
    std::vector<int> below;
    for (const Eigen::Vector3i& t : region.triangles) below.push_back(piece[t[0]]);
    join(below);
  }
  std::vector<std::vector<int>> under;
  for (const Band& band : problem.bands) join(under.emplace_back(pieces_under(band, piece)));
  std::vector<std::vector<int>> separate;
  std::map<int, std::size_t> places;
  for (const int b : all) {
    // A band that nothing can move joins nothing.
    const int root = under[b].empty() ? -1 - b : sets.root(under[b].front());
    const auto [place, first] = places.emplace(root, separate.size());
    if (first) separate.emplace_back();
    separate[place->second].push_back(b);
  }
  return separate;
}

Problem with_bands(const Problem& problem, const std::vector<int>& bands) {
  Problem part{problem.model,       problem.options, {}, 0, problem.rest, {}, {}, {}, {}, {}, {},
               problem.force_scale, problem.folds};
  for (const int b : bands) part.bands.push_back(problem.bands[b]);
  take_tissue(part, {});
  return part;
}

Positions posed(const Problem& problem, double share) {
  Positions x = problem.rest;
  if (problem.options.bones.still()) return x;
  for (Eigen::Vector3d& p : x) p = problem.options.bones.moved(p, share);
  return x;
}

void pose_problem(Problem& problem, double share) {
  if (problem.options.bones.still()) return;
  const geometry::ControlMesh& control = problem.model.control;
  for (std::size_t r = 0; r < problem.volumes.size(); ++r) {
    RegionVolume& volume = problem.volumes[r];
    volume.apex = problem.options.bones.moved(geometry::region_apex(control, control.regions[r]), share);
    if (volume.body_at) volume.body = volume.body_at(share);
  }
  for (Band& band : problem.bands) pose_band(band, problem.rest, problem.options.bones, share);
}

double hold_limit(const Problem& problem, const Band& band) {
  if (!std::isinf(band.tension_limit)) return band.tension_limit;
  return problem.model.options.uniform ? kTightestUniform : kTightestHold / problem.model.newtons();
}

bool skin_folds(const Problem& problem, const Positions& x) {
  if (!problem.folds || problem.bands.empty()) return false;
  Solution shape;
  put_positions(x, problem.model, shape);
  return problem.folds(shape.outer, shape.inner);
}

bool is_held(const Problem& problem, int node) {
  const int count = static_cast<int>(problem.model.control.outer.size());
  const bool inner = node >= count && node < 2 * count;
  return problem.model.is_fixed(node) || (inner && !problem.options.bones.still());
}

Positions positions_of(const Solution& solution) {
  Positions x = solution.outer;
  x.insert(x.end(), solution.inner.begin(), solution.inner.end());
  x.insert(x.end(), solution.between.begin(), solution.between.end());
  return x;
}

void put_positions(const Positions& x, const Model& model, Solution& solution) {
  const auto count = static_cast<std::ptrdiff_t>(model.control.outer.size());
  solution.outer.assign(x.begin(), x.begin() + count);
  solution.inner.assign(x.begin() + count, x.begin() + 2 * count);
  solution.between.assign(x.begin() + 2 * count, x.end());
}

Positions merged(Positions elsewhere, const Positions& x, const std::vector<int>& free_index) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (free_index[i] >= 0) elsewhere[i] = x[i];
  return elsewhere;
}

double relative_residual(const Problem& problem, const Eigen::VectorXd& gradient) {
  if (!gradient.allFinite()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int i = 0; i < problem.free_nodes; ++i)
    largest = std::max(largest, gradient.segment<3>(3 * i).squaredNorm());
  return std::sqrt(largest) / problem.force_scale;
}

void Recorder::look_at(std::vector<int> free_index, Positions elsewhere) {
  free_index_ = std::move(free_index);
  elsewhere_ = std::move(elsewhere);
}

bool Recorder::record(int iteration, const Positions& at, double residual, double merit_change) {
  const Positions x = free_index_.empty() ? at : merged(elsewhere_, at, free_index_);
  Iterate iterate;
  iterate.iteration = iteration;
  for (const Band& band : problem_.bands) iterate.line_ratios.push_back(length_of(band, x) / band.initial);
  for (const RegionVolume& region : problem_.volumes)
    iterate.volume_errors.push_back(volume_error(region, x));
  for (int node : problem_.options.track) iterate.tracked.push_back(x[node]);
  iterate.residual = residual;
  iterate.merit_change = merit_change;
  history.push_back(iterate);
  if (!progress_) return true;
  const auto count = static_cast<std::ptrdiff_t>(problem_.model.control.outer.size());
  return progress_(iterate, {x.begin(), x.begin() + count}, {x.begin() + count, x.begin() + 2 * count});
}

double Recorder::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace tensegric_fit::tensegric
