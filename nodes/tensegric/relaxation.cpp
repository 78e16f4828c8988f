#include "tensegric/relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "tensegric/members.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kMostCycles = 2000;
constexpr double kSettled = 1e-7;    // largest net force / mean tensile force at rest
constexpr double kGathering = 0.3;   // share of the missing push that adds up in a cycle
constexpr double kLeastShare = 0.1;  // of the volume force when it is held back
constexpr double kFarAway = 3;       // a node that moved this many sizes of the model has left it
constexpr int kWindow = 60;          // cycles over which an oscillation is looked for
constexpr double kSwing = 1e-3;      // smallest swing of a line ratio or volume error that counts as one

class Relaxation {
 public:
  Relaxation(const Problem& problem, const Solution* start, bool adaptive)
      : problem_(problem), model_(problem.model), adaptive_(adaptive), x_(problem.rest) {
    if (start != nullptr) {
      x_ = start->outer;
      x_.insert(x_.end(), start->inner.begin(), start->inner.end());
    }
    const Eigen::Vector3d middle = problem.rest.front();
    for (const Eigen::Vector3d& p : problem.rest) size_ = std::max(size_, (p - middle).norm());
    tensile_at_.resize(x_.size());
    struts_at_.resize(x_.size());
    for (std::size_t i = 0; i < model_.members.size(); ++i) {
      const Member& m = model_.members[i];
      auto& lists = m.strut ? struts_at_ : tensile_at_;
      lists[m.a].push_back(static_cast<int>(i));
      lists[m.b].push_back(static_cast<int>(i));
    }
    for (const Member& m : model_.members) {
      if (!m.strut) continue;
      const Eigen::Vector3d span = x_[m.a] - x_[m.b];
      pushes_.push_back(-tension(model_, m, span.norm()) / span.norm() * span);
    }
    gathered_.assign(problem.volumes.size(), 0);
    update_forces();
  }

  void cycle() {
    for (int s = 0; s < model_.struts(); ++s) settle_strut(s);
    update_forces();
  }

  double residual() const {
    Eigen::VectorXd gradient = -external_;
    add_member_gradient(model_, x_, problem_.free_index, gradient);
    return relative_residual(problem_, gradient);
  }

  bool sane() const {
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (!x_[i].allFinite() || (x_[i] - problem_.rest[i]).norm() > kFarAway * size_) return false;
    return true;
  }

  State state() const { return {x_, tensions_}; }

 private:
  // Where a node would go if strut s let go of it: the mean of the ends of its taut parts, with the weight of
  // these.
  struct Centre {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    double weight = 0;
  };

  Centre centre(int node, int strut) const {
    Centre c;
    for (int i : tensile_at_[node]) {
      const Member& m = model_.members[i];
      const Eigen::Vector3d& q = x_[m.a == node ? m.b : m.a];
      const Eigen::Vector3d span = x_[node] - q;
      const double length = span.norm();
      if (length <= m.natural || length == 0) continue;  // slack parts drop out
      c.at += spring(model_, m) * (q + m.natural / length * span);
      c.weight += spring(model_, m);
    }
    Eigen::Vector3d force = external_.segment<3>(3 * problem_.free_index[node]);
    for (int s : struts_at_[node])
      if (s != strut) force += model_.members[s].a == node ? pushes_[s] : Eigen::Vector3d(-pushes_[s]);
    if (c.weight == 0) {  // nothing holds it: it stays, for the strut alone to move
      c.weight = spring(model_, model_.members[strut]);
      c.at = c.weight * x_[node];
    }
    c.at = (c.at + force) / c.weight;
    return c;
  }

  // The closed form of DESIGN §4 with the strut's length between its own and the one that it is pressed to.
  void settle_strut(int s) {
    const Member& m = model_.members[s];
    const bool a_free = problem_.free_index[m.a] >= 0, b_free = problem_.free_index[m.b] >= 0;
    if (!a_free && !b_free) return;
    const Centre a = a_free ? centre(m.a, s) : Centre{x_[m.a], 0},
                 b = b_free ? centre(m.b, s) : Centre{x_[m.b], 0};
    const Eigen::Vector3d apart = a.at - b.at;
    const double distance = apart.norm();
    if (!(distance > 0)) return;
    const Eigen::Vector3d e = apart / distance;
    const double joint = a_free && b_free ? a.weight * b.weight / (a.weight + b.weight) : a.weight + b.weight;
    const double stiffness = spring(model_, m);
    const double length = (joint * distance + stiffness * m.natural) / (joint + stiffness);
    pushes_[s] = stiffness * (m.natural - length) * e;
    if (a_free) x_[m.a] = a.at + pushes_[s] / a.weight;
    if (b_free) x_[m.b] = b.at - pushes_[s] / b.weight;
  }

  void update_forces() {
    const int outer = static_cast<int>(model_.control.outer.size());
    external_ = Eigen::VectorXd::Zero(3 * problem_.free_nodes);
    tensions_.clear();
    for (const Band& band : problem_.bands) {
      const double stretch = smooth_length(band, x_) / band.neutral;
      const double pull = band.law.kind == TensionLaw::Kind::rigid
                              ? problem_.options.line_force * std::max(0.0, stretch - 1)
                              : law_tension(band.law, stretch);
      tensions_.push_back(std::min(pull, band.tension_limit));
      add_length_gradient(band, x_, problem_.free_index, -tensions_.back(), external_);
    }
    const double line_force = external_.norm();
    for (int i = 0; i < outer; ++i)
      if (problem_.free_index[i] >= 0)
        external_.segment<3>(3 * problem_.free_index[i]) += problem_.options.gravity;
    for (std::size_t r = 0; r < problem_.volumes.size(); ++r) push_volume(r, line_force);
  }

  // P1 §3.4; adaptive, P2 §5: held back by as much as the line force is the greater, and what is still
  // missing adds up from cycle to cycle, so that the volume comes back in the end.
  void push_volume(std::size_t r, double line_force) {
    const RegionVolume& region = problem_.volumes[r];
    Eigen::VectorXd push = Eigen::VectorXd::Zero(external_.size());
    add_volume_gradient(region, x_, problem_.free_index, 1 / node_area(region), push);
    const double missing = -problem_.options.volume_force * volume_error(region, x_);
    double share = 1;
    if (adaptive_ && line_force > 0)
      share = std::clamp(std::abs(missing + gathered_[r]) * push.norm() / line_force, kLeastShare, 1.0);
    if (adaptive_) gathered_[r] += kGathering * share * missing;
    external_ += (share * missing + gathered_[r]) * push;
  }

  // Mean size of the volume's gradient at a node, so that a pressure is the mean push at a node.
  double node_area(const RegionVolume& region) const {
    return region.area / std::sqrt(static_cast<double>(region.triangles.size()) / 2);
  }

  const Problem& problem_;
  const Model& model_;
  bool adaptive_;
  Positions x_;
  double size_ = 0;
  std::vector<std::vector<int>> tensile_at_, struts_at_;
  std::vector<Eigen::Vector3d> pushes_;  // of each strut on its node a; the opposite on its node b
  Eigen::VectorXd external_;
  std::vector<double> tensions_, gathered_;  // gathered: push that has added up, one a region
};

// A swing that does not die down: several reversals in the window, as wide in its later half as in its
// earlier.
bool swings(const std::vector<double>& values) {
  const std::size_t half = values.size() / 2;
  const auto spread = [&](std::size_t from, std::size_t to) {
    const auto range = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(from),
                                           values.begin() + static_cast<std::ptrdiff_t>(to));
    return *range.second - *range.first;
  };
  int reversals = 0;
  for (std::size_t i = 2; i < values.size(); ++i)
    if ((values[i] - values[i - 1]) * (values[i - 1] - values[i - 2]) < 0) ++reversals;
  return reversals >= 4 && spread(half, values.size()) > kSwing &&
         spread(half, values.size()) > 0.8 * spread(0, half);
}

bool oscillates(const std::vector<Iterate>& history) {
  if (history.size() < kWindow) return false;
  const Iterate& last = history.back();
  const auto series = [&](auto value) {
    std::vector<double> values;
    for (std::size_t i = history.size() - kWindow; i < history.size(); ++i)
      values.push_back(value(history[i]));
    return values;
  };
  for (std::size_t b = 0; b < last.line_ratios.size(); ++b)
    if (swings(series([b](const Iterate& i) { return i.line_ratios[b]; }))) return true;
  for (std::size_t r = 0; r < last.volume_errors.size(); ++r)
    if (swings(series([r](const Iterate& i) { return i.volume_errors[r]; }))) return true;
  return false;
}

}  // namespace

Outcome relax(const Problem& problem, const Solution* start, bool adaptive, Recorder& recorder) {
  const int most = problem.options.max_iterations > 0 ? problem.options.max_iterations : kMostCycles;
  Relaxation relaxation(problem, start, adaptive);
  Outcome outcome;
  outcome.state = relaxation.state();
  outcome.residual = relaxation.residual();
  while (outcome.residual > kSettled && outcome.iterations < most) {
    relaxation.cycle();
    const double residual = relaxation.residual();
    if (!relaxation.sane() || !std::isfinite(residual)) {
      outcome.status = Status::diverged;
      return outcome;
    }
    outcome.state = relaxation.state();
    outcome.residual = residual;
    if (!recorder.record(++outcome.iterations, outcome.state.x, residual)) return outcome;
  }
  outcome.status = outcome.residual <= kSettled   ? Status::converged
                   : oscillates(recorder.history) ? Status::oscillating
                                                  : Status::capped;
  return outcome;
}

}  // namespace tensegric_fit::tensegric
