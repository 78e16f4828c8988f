#include "tensegric/strut_relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "tensegric/band_length.hpp"
#include "tensegric/members.hpp"
#include "tensegric/tension_law.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr int kStiffeningSteps =
    3;                              // of Newton, from where the linear strut would be; the next cycle goes on
constexpr double kGathering = 0.3;  // share of the missing push that adds up in a cycle
constexpr double kLeastShare = 0.1;     // of the volume force when it is held back
constexpr double kFarAway = 3;          // a node that moved this many sizes of the model has left it
constexpr double kJustTaut = 1 + 1e-6;  // stretch
constexpr double kShortSegment = 3e-3;  // of the model's size: below it a segment's direction is left alone

// Mean size of the volume's gradient at a node, so that a volume force is the mean push at a node.
double node_area(const RegionVolume& region) {
  return region.area / std::sqrt(static_cast<double>(region.triangles.size()) / 2);
}

}  // namespace

StrutRelaxation::StrutRelaxation(const Problem& problem, const Solution* start, bool adaptive)
    : problem_(problem), model_(problem.model), adaptive_(adaptive), x_(problem.rest) {
  if (start != nullptr) x_ = positions_of(*start);
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
    pushes_.push_back(-tension(m, span.norm()) / span.norm() * span);
  }
  gathered_.assign(problem.volumes.size(), 0);
  update_forces();
}

void StrutRelaxation::cycle() {
  for (int s = 0; s < model_.struts(); ++s) settle_strut(s);
  update_forces();
}

double StrutRelaxation::residual() const {
  Eigen::VectorXd gradient = -external_;
  add_member_gradient(model_, x_, problem_.free_index, gradient);
  return relative_residual(problem_, gradient);
}

bool StrutRelaxation::sane() const {
  for (std::size_t i = 0; i < x_.size(); ++i)
    if (!x_[i].allFinite() || (x_[i] - problem_.rest[i]).norm() > kFarAway * size_) return false;
  return true;
}

StrutRelaxation::Centre StrutRelaxation::centre(int node, int strut) const {
  Centre c;
  double held = held_[node];
  for (int i : tensile_at_[node]) {
    const Member& m = model_.members[i];
    const Eigen::Vector3d& q = x_[m.a == node ? m.b : m.a];
    const Eigen::Vector3d span = x_[node] - q;
    const double length = span.norm();
    if (length <= m.natural || length == 0) {  // slack parts drop out
      held += spring(m);
      continue;
    }
    c.at += secant(m, length) * (q + m.natural / length * span);
    c.weight += secant(m, length);
  }
  Eigen::Vector3d force = external_.segment<3>(3 * problem_.free_index[node]);
  for (int s : struts_at_[node]) {
    if (s == strut) continue;
    const Member& m = model_.members[s];
    held += spring(m);
    if (adaptive_) {
      const Eigen::Vector3d span = x_[m.a] - x_[m.b];
      const double length = span.norm();
      if (length > 0) force -= (m.a == node ? 1 : -1) * tension(m, length) / length * span;
    } else {
      force += m.a == node ? pushes_[s] : Eigen::Vector3d(-pushes_[s]);
    }
  }
  if (!adaptive_) held = c.weight == 0 ? spring(model_.members[strut]) : 0;
  c.at += held * x_[node];
  c.weight += held;
  c.at = (c.at + force) / c.weight;
  return c;
}

// The closed form in README.md with the strut's length between its own and the one that it is pressed to.
void StrutRelaxation::settle_strut(int s) {
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
  double length = (joint * distance + spring(m) * m.natural) / (joint + spring(m));
  if (m.stiffening > 0)
    for (int i = 0; i < kStiffeningSteps; ++i)
      length -= (joint * (length - distance) + tension(m, length)) / (joint + tangent(m, length));
  pushes_[s] = -tension(m, length) * e;
  if (a_free) x_[m.a] = a.at + pushes_[s] / a.weight;
  if (b_free) x_[m.b] = b.at - pushes_[s] / b.weight;
}

void StrutRelaxation::update_forces() {
  const int outer = static_cast<int>(model_.control.outer.size());
  external_ = Eigen::VectorXd::Zero(3 * problem_.free_nodes);
  held_.assign(x_.size(), 0);
  tensions_.clear();
  for (const Band& band : problem_.bands) pull(band);
  const double line_force = external_.norm();
  for (int i = 0; i < outer; ++i)
    if (problem_.free_index[i] >= 0)
      external_.segment<3>(3 * problem_.free_index[i]) += problem_.options.gravity;
  for (std::size_t r = 0; r < problem_.volumes.size(); ++r) push_volume(r, line_force);
}

void StrutRelaxation::pull(const Band& band) {
  const double stretch = smooth_length(band, x_) / band.neutral;
  const bool rigid = band.law.kind == TensionLaw::Kind::rigid;
  const double tension =
      rigid ? problem_.options.line_force * std::max(0.0, stretch - 1) : law_tension(band.law, stretch);
  tensions_.push_back(std::min(tension, band.tension_limit));
  add_length_gradient(band, x_, problem_.free_index, -tensions_.back(), external_);
  if (!adaptive_) return;
  const double slope = tension > band.tension_limit ? 0
                       : rigid                      ? problem_.options.line_force
                                                    : law_slope(band.law, std::max(stretch, kJustTaut));
  hold_back(band, slope / band.neutral, tensions_.back());
}

// Along the band its tension grows by `slope`, as all its nodes move at once; across it the tension itself
// turns.
void StrutRelaxation::hold_back(const Band& band, double slope, double tension) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(external_.size());
  add_length_gradient(band, x_, problem_.free_index, 1, gradient);
  const double along = slope * gradient.squaredNorm();
  std::vector<char> touched(x_.size(), 0);
  for (const Thread& thread : band.threads) {
    for (const auto& span : thread.spans) {
      Eigen::Vector3d apart = Eigen::Vector3d::Zero();
      double whole = 0;
      for (const auto& [node, weight] : span) {
        apart += weight * x_[node];
        whole += std::abs(weight);
        touched[node] = 1;
      }
      const double stiffness = thread.share * tension / std::max(apart.norm(), kShortSegment * size_);
      for (const auto& [node, weight] : span) held_[node] += stiffness * std::abs(weight) * whole;
    }
  }
  for (std::size_t i = 0; i < touched.size(); ++i)
    if (touched[i]) held_[i] += along;
}

// The pushes of P1's way are as old as their struts' last turn; the adaptive way has no memory of them.
Eigen::VectorXd StrutRelaxation::packed() const {
  const auto nodes = static_cast<Eigen::Index>(x_.size()),
             regions = static_cast<Eigen::Index>(gathered_.size()),
             struts = adaptive_ ? 0 : static_cast<Eigen::Index>(pushes_.size());
  Eigen::VectorXd all(3 * (nodes + struts) + external_.size() + regions);
  Eigen::Index at = 0;
  for (const Eigen::Vector3d& p : x_) all.segment<3>(3 * at++) = p;
  for (Eigen::Index s = 0; s < struts; ++s) all.segment<3>(3 * at++) = size_ * pushes_[s];
  all.segment(3 * at, external_.size()) = size_ * external_;
  all.tail(regions) = size_ * Eigen::Map<const Eigen::VectorXd>(gathered_.data(), regions);
  return all;
}

void StrutRelaxation::unpack(const Eigen::VectorXd& all) {
  const auto regions = static_cast<Eigen::Index>(gathered_.size()),
             struts = adaptive_ ? 0 : static_cast<Eigen::Index>(pushes_.size());
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < x_.size(); ++i, ++at)
    if (problem_.free_index[i] >= 0) x_[i] = all.segment<3>(3 * at);
  for (Eigen::Index s = 0; s < struts; ++s) pushes_[s] = all.segment<3>(3 * at++) / size_;
  external_ = all.segment(3 * at, external_.size()) / size_;
  Eigen::Map<Eigen::VectorXd>(gathered_.data(), regions) = all.tail(regions) / size_;
}

// P1 §3.4; adaptive, P2 §5: held back by as much as the line force is the greater, and what is still
// missing adds up from cycle to cycle, so that the volume comes back in the end.
void StrutRelaxation::push_volume(std::size_t r, double line_force) {
  const RegionVolume& region = problem_.volumes[r];
  Eigen::VectorXd push = Eigen::VectorXd::Zero(external_.size());
  add_volume_gradient(region, x_, problem_.free_index, 1 / node_area(region), push);
  const double missing = -problem_.options.volume_force * volume_error(region, x_);
  double share = 1;
  if (adaptive_ && line_force > 0)
    share = std::clamp(std::abs(missing + gathered_[r]) * push.norm() / line_force, kLeastShare, 1.0);
  if (adaptive_) gathered_[r] += kGathering * share * missing;
  external_ += (share * missing + gathered_[r]) * push;
  if (!adaptive_) return;
  const double stiffness =
      problem_.options.volume_force * push.squaredNorm() * node_area(region) / volume_scale(region);
  for (std::size_t i = 0; i < model_.control.outer.size(); ++i) held_[i] += stiffness;
}

}  // namespace tensegric_fit::tensegric
