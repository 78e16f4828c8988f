#include "tensegric/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tensegric/band_length.hpp"
#include "tensegric/tension_law.hpp"

namespace tensegric_fit::tensegric {
namespace {

// This near to a balance that is no minimum the model cannot distinguish one way down from the other: a
// symmetric one stays symmetric.
constexpr Tolerance kAtSaddle{1e-5, 1e-6, 1e-6};
// This near, a matrix that is no minimum's is one of a balance, not of a shape far from any.
constexpr Tolerance kNearBalance{0.2, 1e-4, 1e-4};
constexpr int kMostHoldChanges = 20, kMostHalvings = 14;
constexpr double kRounding = 32 * std::numeric_limits<double>::epsilon();  // of the coordinates
constexpr double kContradicted = 1e-6;  // of a neutral length: far above rounding
constexpr int kMostFurtherSteps = 4;    // by one matrix: 1, 2 and 4 were tried (tests/stability/README.md)
constexpr double kMostLeftOver =
    0.5;  // of the residual, after a further step: else the matrix is too far off
constexpr int kMostMends = 8;
constexpr double kMended = 1e-12;     // relative, of volumes and lengths
constexpr double kSlightPush = 1e-9;  // of the force scale: rounding
constexpr int kStepsBeyondLimit = 3;  // a tension may overshoot in an iteration or two
constexpr int kLeastCap = 400;        // of factorisations: 20 to 60 are usual; on fine meshes each takes long

// m, of a node.
double longest_of(const Eigen::VectorXd& move) {
  double longest = 0;
  for (Eigen::Index i = 0; i < move.size(); i += 3) longest = std::max(longest, move.segment<3>(i).norm());
  return longest;
}

}  // namespace

bool within(const KktResidual& d, const Tolerance& t) {
  return d.residual <= t.residual && d.volume_error <= t.volume && d.length_error <= t.length &&
         d.tension_error <= t.residual;
}

Newton::Newton(const Problem& problem, Recorder& recorder, int spent, int most)
    : problem_(problem),
      recorder_(recorder),
      kkt_(problem),
      iterations_(spent),
      most_iterations_(most),
      most_factorisations_(std::max(kLeastCap, 4 * (most - spent) / 3)) {
  double sum = 0;
  for (const Member& m : problem.model.members) sum += m.rest;
  for (const Eigen::Vector3d& p : problem.rest) farthest_ = std::max(farthest_, p.cwiseAbs().maxCoeff());
  longest_move_ = sum / static_cast<double>(problem.model.members.size()) / 2;
}

Stop Newton::spent() const {
  if (iterations_ >= most_iterations_ || kkt_.factorisations() >= most_factorisations_)
    return Stop::iterations;
  const double budget = problem_.options.time_budget;
  return budget > 0 && recorder_.seconds() >= budget ? Stop::time : Stop::none;
}

bool Newton::settle(Balance& at, const Load& load, const Tolerance& tolerance, int most) {
  penalties_ =
      Eigen::VectorXd::Zero(problem_.volumes.size() + static_cast<Eigen::Index>(problem_.bands.size()));
  int changes = 0;
  bool passes_branch = false;
  bool looked = true;  // at the second derivative near balance, or there was nothing to be done
  KktResidual defect = kkt_.defect(at, load);
  const auto settled = [&](bool balanced) {
    if (balanced && !looked && tolerance.residual < kNearBalance.residual)
      passes_branch = !kkt_.step(at, load, defect, true, true).minimum;
    branch_near_ = branch_near_ || (balanced && passes_branch);
    return balanced;
  };
  const auto goes_on = [&] {  // after holds have changed
    defect = kkt_.defect(at, load);
    return ++changes <= kMostHoldChanges;
  };
  for (int i = 0; i <= most; ++i) {
    while ((within(defect, tolerance) && change_holds(at, load)) ||
           (i >= kStepsBeyondLimit && change_holds_off_balance(at, load))) {
      if (!goes_on()) return false;
    }
    if (within(defect, tolerance)) return settled(true);
    stop_ = spent();
    if (i == most || stop_ != Stop::none) return settled(is_balance(at, load, defect));
    Step step = kkt_.step(at, load, defect, within(defect, kAtSaddle), true);
    looked = within(defect, kNearBalance);
    passes_branch = passes_branch || (!step.minimum && looked);
    if (!step.move.allFinite() || !step.multipliers.allFinite()) return false;
    if (release_contradicted(at, load, step)) {
      if (!goes_on()) return false;
      continue;
    }
    if (is_rounding(step)) {  // holds need not wait for a residual that rounding forbids
      if (change_holds(at, load)) {
        if (!goes_on()) return false;
        continue;
      }
      if (within(defect, kWanted)) return settled(true);
    }
    if (!advance(at, load, defect, step, tolerance)) {
      step = kkt_.step(at, load, defect, within(defect, kAtSaddle), false);
      if (!step.move.allFinite() || !step.multipliers.allFinite() ||
          !advance(at, load, defect, step, tolerance))
        return settled(is_balance(at, load, defect));
    }
    if (!recorder_.record(++iterations_, at.x, defect.residual, merit_change_)) {
      stop_ = Stop::caller;
      return false;
    }
  }
  return false;
}

// Where the parts of a unit that is nearly flat at rest push and pull with many times what acts on them, no
// step comes nearer to balance than rounding lets it.
bool Newton::is_rounding(const Step& step) const {
  return step.move.size() > 0 && step.move.cwiseAbs().maxCoeff() <= kRounding * farthest_;
}

// Good enough, though not as good as aimed at.
bool Newton::is_balance(Balance at, const Load& load, const KktResidual& defect) const {
  return within(defect, kWanted) && !change_holds(at, load);
}

void Newton::mend(Balance& at, const Load& load) const {
  for (int i = 0; i < kMostMends; ++i) {
    const KktResidual defect = kkt_.defect(at, load);
    if (defect.volume_error <= kMended && defect.length_error <= kMended) return;
    Eigen::VectorXd broken = defect.conditions;
    for (Eigen::Index b = at.pressures.size(); b < broken.size(); ++b)
      if (at.holds[b - at.pressures.size()] != Hold::length) broken[b] = 0;
    Positions mended = at.x;
    move(mended, Kkt::shortest_move(defect, broken));
    if (!std::isfinite(fold_energy(problem_.units, mended))) return;
    at.x = mended;
  }
}

// Line search on energy plus penalties for broken conditions. The full step is followed by further ones by
// the same matrix, or else by a second-order correction. `at` and its defect go where it ends.
bool Newton::advance(Balance& at, const Load& load, KktResidual& defect, const Step& step,
                     const Tolerance& tolerance) {
  const Eigen::Index regions = at.pressures.size(), bands = at.tensions.size();
  const auto kept = [&](Eigen::Index i) { return i < regions || at.holds[i - regions] == Hold::length; };
  double slope = defect.gradient.dot(step.move);
  for (Eigen::Index i = 0; i < penalties_.size(); ++i) {
    const double multiplier = i < regions ? at.pressures[i] : at.tensions[i - regions];
    if (kept(i)) {
      penalties_[i] = std::max(penalties_[i], 2 * std::abs(multiplier + step.multipliers[i]));
      slope += multiplier * defect.conditions[i] - penalties_[i] * std::abs(defect.conditions[i]);
    } else {
      slope += defect.conditions[i] * defect.jacobian.col(i).dot(step.move);
    }
  }
  const auto merit = [&](const Balance& b, const KktResidual& d) {
    double value = kkt_.energy(b, load);
    for (Eigen::Index i = 0; i < penalties_.size(); ++i)
      if (kept(i)) value += penalties_[i] * std::abs(d.conditions[i]);
    return value;
  };
  const double start = merit(at, defect);
  const auto is_enough = [&](double reached, double length) {
    return reached <= start + 1e-4 * length * std::min(slope, 0.0) + 1e-12 * std::abs(start);
  };
  const double longest = longest_of(step.move);
  double reached = start;
  // Steps on what is left over, by the same matrix: most of a step's time goes into that and its factors.
  const auto go_on = [&](Balance& from, KktResidual& left) {
    int steps = 0;
    for (; steps < kMostFurtherSteps && std::isfinite(left.residual) && !within(left, tolerance); ++steps) {
      const Step step_on = kkt_.step_again(left);
      if (!(longest_of(step_on.move) <= longest)) break;
      Balance next = from;
      move(next.x, step_on.move);
      next.pressures += step_on.multipliers.head(regions);
      next.tensions += step_on.multipliers.tail(bands);
      next.pushes.setZero();  // not foreseen: lines touch at the units' own shares
      KktResidual beyond = kkt_.defect(next, load);
      const double merit_there = merit(next, beyond);
      if (!(beyond.residual <= kMostLeftOver * left.residual) || !is_enough(merit_there, 1)) break;
      from = std::move(next);
      left = std::move(beyond);
      reached = merit_there;
    }
    return steps > 0;
  };
  double length = longest > longest_move_ ? longest_move_ / longest : 1;
  for (int halving = 0; halving < kMostHalvings; ++halving, length /= 2) {
    Balance trial = at;
    move(trial.x, length * step.move);
    trial.pressures += length * step.multipliers.head(regions);
    trial.tensions += length * step.multipliers.tail(bands);
    // A push goes the whole step, however short the way of the nodes is: cut with it, it would take ten steps
    // to hold a node at its barrier. One that would end goes as far as the nodes do.
    trial.pushes.setZero(static_cast<Eigen::Index>(problem_.units.size()));
    for (std::size_t k = 0; k < step.lines.size(); ++k) {
      const double push = step.lines[k].push, change = step.push_change[static_cast<Eigen::Index>(k)];
      trial.pushes[step.lines[k].unit] = push + change > 0 ? push + change : push + length * change;
    }
    KktResidual there = kkt_.defect(trial, load);
    const bool gone_on = length == 1 && go_on(trial, there);
    if (length == 1 && !gone_on) {
      Eigen::VectorXd broken = there.conditions;
      for (Eigen::Index i = 0; i < broken.size(); ++i)
        if (!kept(i)) broken[i] = 0;
      move(trial.x, kkt_.correction(broken));
      there = kkt_.defect(trial, load);
    }
    if (!gone_on) reached = merit(trial, there);
    if (is_enough(reached, length)) {
      merit_change_ = (reached - start) / std::max(std::abs(start), std::numeric_limits<double>::min());
      at = trial;
      defect = std::move(there);
      return true;
    }
  }
  return false;
}

void Newton::move(Positions& x, const Eigen::VectorXd& by) const {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (problem_.free_index[i] >= 0) x[i] += by.segment<3>(3 * problem_.free_index[i]);
}

// Of lines that run over the same nodes one may be short enough without pulling. Kept at their lengths
// together they contradict each other, and the step is a compromise: lets go of the line that it would
// shorten most. A line that lies straight between its fixed nodes and is asked to be shorter yet has no way
// to shorten: it pulls as far as it may.
bool Newton::release_contradicted(Balance& at, const Load& load, const Step& step) const {
  const Eigen::Index regions = at.pressures.size();
  int shortened = -1;
  double most = kContradicted;
  bool hopeless = false;
  for (std::size_t b = 0; b < problem_.bands.size(); ++b) {
    if (at.holds[b] != Hold::length) continue;
    const double share = -step.left_over[regions + static_cast<Eigen::Index>(b)] / load.neutral[b];
    if (share < -kContradicted && problem_.bands[b].law.kind == TensionLaw::Kind::rigid &&
        load.neutral[b] < problem_.bands[b].straight) {
      at.holds[b] = Hold::limit;
      at.tensions[b] = load.limit[b];
      hopeless = true;
    }
    if (share <= most) continue;
    most = share;
    shortened = static_cast<int>(b);
  }
  if (hopeless) return true;
  if (shortened >= 0) at.holds[shortened] = Hold::slack;
  return shortened >= 0;
}

// What never comes near enough to balance for change_holds. A request that is out of reach: its tension grows
// beyond its limit. Lines that run nearly the same way, kept at their lengths together: some pull, others
// push as much, and the step that would let go of them is far away; the one that pushes most is let go.
bool Newton::change_holds_off_balance(Balance& at, const Load& load) const {
  bool changed = false;
  int pushes = -1;
  double most = kSlightPush * problem_.force_scale;
  for (std::size_t b = 0; b < problem_.bands.size(); ++b) {
    if (at.holds[b] != Hold::length) continue;
    if (-at.tensions[b] > most) {
      most = -at.tensions[b];
      pushes = static_cast<int>(b);
    }
    if (!(at.tensions[b] > load.limit[b])) continue;
    at.holds[b] = Hold::limit;
    at.tensions[b] = load.limit[b];
    changed = true;
  }
  if (pushes < 0) return changed;
  at.holds[pushes] = Hold::slack;
  at.tensions[pushes] = 0;
  return true;
}

// Lets go of lines that would push, takes hold of lines that would be too long, and stops at the tension
// limits.
bool Newton::change_holds(Balance& at, const Load& load) const {
  const double slight = kSlightPush * problem_.force_scale;
  bool changed = false;
  for (std::size_t b = 0; b < problem_.bands.size(); ++b) {
    const Band& band = problem_.bands[b];
    const bool rigid = band.law.kind == TensionLaw::Kind::rigid;
    if (rigid && !band.movable) continue;
    const double length = smooth_length(band, at.x), neutral = load.neutral[b], pull = at.tensions[b];
    Hold hold = at.holds[b];
    if (hold == Hold::length && pull < -slight)
      hold = Hold::slack;
    else if (hold == Hold::slack && length > neutral * law_stretch(band.law, 0) * (1 + 1e-9))
      hold = Hold::length;
    else if (hold != Hold::limit && pull > load.limit[b] + slight)
      hold = Hold::limit;
    else if (hold == Hold::limit && band.steep && length < neutral * law_stretch(band.law, load.limit[b]))
      hold = Hold::length;
    else if (hold == Hold::limit && !band.steep &&
             law_tension(band.law, length / neutral) < load.limit[b] - slight)
      hold = Hold::elastic;
    changed = changed || hold != at.holds[b];
    at.holds[b] = hold;
  }
  return changed;
}

}  // namespace tensegric_fit::tensegric
