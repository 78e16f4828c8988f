#include "tensegric/tensegric_handler.hpp"

#include <fmt/format.h>

#include <boost/make_shared.hpp>

#include <algorithm>
#include <chrono>

#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "geometry/tffd_reach.hpp"
#include "ros/body_messages.hpp"
#include "tensegric/kept_garment_message.hpp"
#include "tensegric/problem.hpp"

namespace tensegric_fit::node {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// What fitters take besides control meshes.
std::optional<geometry::BodyMeasures> measures_of(const TensegricHandler::Input& input) {
  return input.landmarks ? std::optional(measures_in(*input.landmarks)) : std::nullopt;
}

/// What a scan_id says of the points alone: of a file that is played over and over the stamp changes.
std::string points_in_scan(const std::string& scan_id) {
  return scan_id.substr(scan_id.rfind('-') + 1);
}

std::function<geometry::TriangleMesh()> body_of(const TensegricHandler::Input& input) {
  return [body = input.body] { return mesh_in(*body); };
}

}  // namespace

TensegricHandler::Setup TensegricHandler::setup_from(Parameters& parameters) {
  Setup setup;
  tensegric::ModelOptions& model = setup.fitter.model;
  model.inner = tensegric::inner_nodes_from(
      parameters.choice("inner_nodes", to_string(model.inner), tensegric::kInnerWords.all()));
  model.layers = parameters.integer("layers", model.layers, tensegric::kLayers);
  model.uniform = parameters.flag("uniform_stiffness", model.uniform);
  for (const tensegric::ModelNumber& number : tensegric::kModelNumbers)
    model.*number.field = parameters.number(number.name, model.*number.field, number.range);
  for (const std::string& part : parameters.texts("stiff_parts"))
    model.stiff_parts.push_back(tensegric::stiff_part_from(part));
  tensegric::FitterOptions& fitter = setup.fitter;
  fitter.beta = parameters.number("beta", fitter.beta, geometry::kBetaOrNone);
  geometry::check_beta(fitter.beta);
  tensegric::SolverOptions& solver = setup.fitter.solver;
  solver.solver = tensegric::solver_from(
      parameters.choice("solver", to_string(solver.solver), tensegric::kSolverWords.all()));
  solver.max_iterations =
      parameters.integer("max_iterations", solver.max_iterations, tensegric::kMaxIterations);
  solver.time_budget = parameters.number("time_budget", solver.time_budget, tensegric::kTimeBudget);
  solver.volume = *tensegric::kVolumeWords.find(
      parameters.choice("volume", tensegric::kVolumeWords.of(solver.volume), tensegric::kVolumeWords.all()));
  solver.gravity = parameters.vector("gravity", solver.gravity);
  solver.line_force = parameters.number("line_force", solver.line_force, tensegric::kPseudoForce);
  solver.volume_force = parameters.number("volume_force", solver.volume_force, tensegric::kPseudoForce);
  geometry::Posture& posture = setup.fitter.posture;
  posture.twist =
      parameters.number("twist", posture.twist, {-geometry::kLargestTwist, geometry::kLargestTwist});
  posture.side_lean =
      parameters.number("side_lean", posture.side_lean, {-geometry::kLargestLean, geometry::kLargestLean});
  setup.progress_period = parameters.number("progress_period", setup.progress_period, {0.001, 60});
  setup.garment = parameters.text("garment", setup.garment);
  setup.kept = parameters.text("worn", "");
  setup.heard = parameters.text("heard", "");
  if (!setup.kept.empty() && !kept_garment(setup.kept, setup.garment)) setup.heard.clear();  // another start
  setup.garment_directory = parameters.text("garment_directory", geometry::shipped_folder("garments"));
  parameters.check_all_known();
  return setup;
}

TensegricHandler::TensegricHandler(Parameters parameters, tensegric::BindBody bind_body)
    : setup_(setup_from(parameters)),
      first_{tensegric::take_garment(setup_.garment, setup_.garment_directory), ""},
      worn_(kept_garment(setup_.kept, setup_.garment).value_or(first_)),
      heard_(setup_.heard),
      fitter_(setup_.fitter, bind_body),
      bind_body_(std::move(bind_body)) {}

std::optional<TensegricHandler::Input> TensegricHandler::add(const ControlMesh::ConstPtr& control) {
  control_ = control;
  fresh_ = true;
  return newly_complete();
}

std::optional<TensegricHandler::Input> TensegricHandler::add(const Landmarks::ConstPtr& landmarks) {
  landmarks_ = landmarks;
  return newly_complete();
}

std::optional<TensegricHandler::Input> TensegricHandler::add(const TriangleMesh::ConstPtr& body) {
  body_ = body;
  return newly_complete();
}

std::optional<TensegricHandler::Input> TensegricHandler::newly_complete() {
  if (!fresh_ || !complete()) return std::nullopt;
  fresh_ = false;
  {
    const std::lock_guard<std::mutex> lock(coarse_mutex_);
    if (coarse_ && coarse_->scan_id != control_->scan_id) coarse_.reset();  // of the body before
  }
  if (worn_.of && worn_.of->empty()) worn_.of = control_->scan_id;
  const std::string why = unwearable();
  unseen_ = false;
  if (!why.empty()) worn_ = first_;
  Input complete = input();
  complete.taken_off = why;
  return complete;
}

/// Why the garment worn is not for this body, where another one is to be worn in its place.
std::string TensegricHandler::unwearable() const {
  const std::string& name = worn_.garment.name;
  if (worn_.of && points_in_scan(*worn_.of) != points_in_scan(control_->scan_id))
    return fmt::format("garment '{}' has lines by points, which lie on the body of an earlier scan", name);
  if (!unseen_) return "";  // a scan that lacks a region is refused by name, and the garment stays on
  try {
    tensegric::check_names(control_in(*control_), worn_.garment);
    return "";
  } catch (const geometry::Refusal& refusal) {
    try {  // the first garment's own fault is this scan's
      tensegric::check_names(control_in(*control_), first_.garment);
    } catch (const geometry::Refusal&) {
      return "";
    }
    return refusal.what();
  }
}

GarmentRequest TensegricHandler::of_body(GarmentRequest request) const {
  const std::vector<tensegric::GarmentLine>& lines = request.garment.lines;
  if (std::any_of(lines.begin(), lines.end(), [](const auto& line) { return !line.points.empty(); }))
    request.of = body_ ? body_->scan_id : "";
  return request;
}

std::optional<TensegricHandler::Input> TensegricHandler::put_on(const Garment& garment,
                                                                const std::string& publisher, bool latched) {
  if (!heard_.is_new(publisher, {garment.header.stamp.toNSec(), checksum_of(garment), latched}))
    return std::nullopt;
  return wear(of_body(request_in(garment)));
}

std::optional<TensegricHandler::Input> TensegricHandler::put_on(const SetGarment::Request& request) {
  return wear(of_body(request_in(request, setup_.garment_directory)));
}

std::optional<TensegricHandler::Input> TensegricHandler::wear(GarmentRequest request) {
  check(request.garment);
  worn_ = std::move(request);
  unseen_ = !complete();
  if (unseen_) return std::nullopt;
  return input();
}

std::optional<TensegricHandler::Input> TensegricHandler::reset() {
  check(first_.garment);
  ++rests_;
  return wear(first_);
}

// Not on the body of the customer before.
void TensegricHandler::check(const tensegric::Garment& garment) const {
  if (!complete()) return;
  if (fitter_.knows(control_->scan_id))
    fitter_.check(garment, control_->scan_id);
  else  // it is still to be made ready
    tensegric::check_names(control_in(*control_), garment);
}

// The body says which scan is the newest: one that was refused later on has no control mesh.
bool TensegricHandler::complete() const {
  const auto fits = [this](const auto& message) { return message && message->scan_id == control_->scan_id; };
  return control_ && fits(body_) && (!needs_landmarks() || fits(landmarks_));
}

TensegricHandler::Input TensegricHandler::input() const {
  return {control_, needs_landmarks() ? landmarks_ : nullptr, body_, worn_, rests_};
}

bool TensegricHandler::needs_landmarks() const {
  return setup_.fitter.posture.twist != 0 || setup_.fitter.posture.side_lean != 0;
}

void TensegricHandler::add_coarse(const ControlMesh::ConstPtr& coarse) {
  const std::lock_guard<std::mutex> lock(coarse_mutex_);
  coarse_ = coarse;
}

ControlMesh::ConstPtr TensegricHandler::coarse_of(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(coarse_mutex_);
  return coarse_ && coarse_->scan_id == scan_id ? coarse_ : nullptr;
}

std::string TensegricHandler::outlook() const {
  if (complete()) return "fitting to scan " + control_->scan_id;
  if (body_) return "kept: scan " + body_->scan_id + " has no control mesh so far";
  return "kept until a scan comes";
}

std::string TensegricHandler::kept() const {
  return kept_text(setup_.garment, worn_);
}

// Nothing where it was stopped, or where this garment has none: what is to be refused is refused on the fine
// mesh, which fitter_ has taken.
std::optional<FitState> TensegricHandler::first_answer(const Input& input,
                                                       const ControlMesh::ConstPtr& coarse,
                                                       const FitName& name,
                                                       const std::function<bool()>& go_on) {
  const bool has_weight = !setup_.fitter.solver.gravity.isZero(0);  // forces of the fine mesh's nodes
  if (!coarse || has_weight) return std::nullopt;
  const auto start = Clock::now();
  try {
    if (!coarse_fitter_ || coarse != coarse_taken_) {
      coarse_taken_.reset();
      coarse_fitter_.emplace(setup_.fitter, bind_body_);
      const auto measures = measures_of(input);
      coarse_fitter_->take(control_in(*coarse), control_in(*input.control), measures ? &*measures : nullptr,
                           body_of(input));
      coarse_taken_ = coarse;
    }
    const auto answer = coarse_fitter_->fit(input.request.garment, fitter_.model()->newtons(), name.solver,
                                            input.rest, go_on);
    if (!answer) return std::nullopt;
    FitState state = to_message(name, answer->state, answer->outer, answer->inner, milliseconds_since(start));
    state.note =
        fmt::format("the first answer, found on control/coarse ({} triangles); that on control/mesh follows",
                    answer->triangles);
    return state;
  } catch (const geometry::Refusal&) {
    if (!coarse_taken_) coarse_fitter_.reset();
    return std::nullopt;
  }
}

std::optional<TensegricHandler::Output> TensegricHandler::handle(
    const Input& input, const std::function<bool()>& go_on,
    const std::function<void(const FitState&)>& publish) {
  const GarmentRequest& request = input.request;
  const tensegric::SolverName solver =
      request.solver.empty() ? setup_.fitter.solver.solver : tensegric::solver_from(request.solver);
  const FitName name{tag_in(*input.control), request.garment.name, solver, setup_.fitter.posture};
  const auto start = Clock::now();
  if (input.control != taken_) {
    coarse_fitter_.reset();  // it knows the body before
    coarse_taken_.reset();
    taken_.reset();
    const auto measures = measures_of(input);
    fitter_.take(input.control->scan_id, control_in(*input.control), measures ? &*measures : nullptr,
                 body_of(input));
    taken_ = input.control;
  }
  // Only now: the order of messages on two topics is not kept, and the control mesh may be here first.
  const ControlMesh::ConstPtr coarse = coarse_of(input.control->scan_id);
  const std::optional<FitState> first = first_answer(input, coarse, name, go_on);
  if (first)
    publish(*first);
  else if (coarse && !go_on())
    return std::nullopt;
  double published = 0;
  const auto progress = [&](const tensegric::Iterate& iterate, const std::vector<Eigen::Vector3d>& outer,
                            const std::vector<Eigen::Vector3d>& inner) {
    const double now = milliseconds_since(start);
    if (!first && now - published >= 1000 * setup_.progress_period) {
      publish(to_message(name, iterate, outer, inner, now));
      published = now;
    }
    return go_on();
  };
  std::optional<tensegric::Solution> solution = fitter_.fit(request.garment, solver, input.rest, progress);
  if (!solution) return std::nullopt;

  const auto message = boost::make_shared<FitState>(to_message(name, *solution, milliseconds_since(start)));
  const std::shared_ptr<const tensegric::Model> model = fitter_.model();
  return Output{message,
                boost::make_shared<LineForces>(forces_message(name, *solution)),
                name,
                model,
                std::move(*solution),
                {{"garment", message->garment},
                 {"solver", message->solver},
                 {"status", message->status},
                 {"iterations", std::to_string(message->iteration)}}};
}

}  // namespace tensegric_fit::node
