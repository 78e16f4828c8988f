#include "tensegric/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tensegric/kkt.hpp"

namespace tensegric_fit::tensegric {
namespace {

struct Tolerance {
  double residual, volume, length;
};
constexpr Tolerance kExact{1e-10, 1e-12, 1e-11};  // what is aimed at
constexpr Tolerance kWanted{1e-8, 1e-9, 1e-8};  // what counts as balanced (DESIGN §7 asks for 1e-6 in length)
constexpr Tolerance kOnTheWay{5e-2, 1e-4, 1e-4};  // at a load between rest and the request
// This near to a balance that is no minimum the model has nothing to tell one way down from the other: a
// symmetric one stays symmetric.
constexpr Tolerance kAtSaddle{1e-5, 1e-6, 1e-6};
constexpr double kHighestTension = 20;    // where a line has no limit of its own; times k
constexpr double kFirstRatioStep = 0.03;  // change of a neutral length in the first load step, relative
constexpr double kShortestLoadStep = 1.0 / 1024;
constexpr int kMostIterations = 300, kMostPerLoad = 30, kMostAtEnd = 80, kMostHoldChanges = 20;

bool within(const Defect& d, const Tolerance& t) {
  return d.residual <= t.residual && d.volume_error <= t.volume && d.length_error <= t.length &&
         d.tension_error <= t.residual;
}

class LoadPath {
 public:
  LoadPath(const Problem& problem, Recorder& recorder)
      : problem_(problem), recorder_(recorder), kkt_(problem), bands_(problem.bands.size()) {
    double sum = 0;
    for (const Member& m : problem.model.members) sum += m.rest;
    longest_move_ = sum / problem.model.members.size() / 2;
    most_iterations_ = problem.options.max_iterations > 0 ? problem.options.max_iterations : kMostIterations;
  }

  Outcome from_rest() {
    Balance at{
        problem_.rest, Eigen::VectorXd::Zero(problem_.volumes.size()), Eigen::VectorXd::Zero(bands_), {}};
    first_ = end_load();
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      first_.neutral[b] = band.initial;
      at.holds.push_back(band.law.kind != TensionLaw::Kind::rigid      ? Hold::elastic
                         : band.neutral < band.initial && band.movable ? Hold::length
                                                                       : Hold::slack);
    }
    first_.gravity.setZero();
    return follow(at);
  }

  Outcome from_solution(const Solution& start) {
    Balance at{
        start.outer, Eigen::VectorXd::Zero(problem_.volumes.size()), Eigen::VectorXd::Zero(bands_), {}};
    at.x.insert(at.x.end(), start.inner.begin(), start.inner.end());
    first_ = end_load();
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const bool rigid = band.law.kind == TensionLaw::Kind::rigid;
      const double length = smooth_length(band, at.x);
      first_.neutral[b] = rigid ? std::max(length, band.neutral) : length;
      for (const LineResult& line : start.lines) {
        if (line.name != band.name || line.tension <= 0) continue;
        first_.neutral[b] = line.neutral;
        at.tensions[b] = line.tension;
      }
      at.holds.push_back(!rigid                                        ? Hold::elastic
                         : at.tensions[b] >= first_.limit[b]           ? Hold::limit
                         : at.tensions[b] > 0 || length > band.neutral ? Hold::length
                                                                       : Hold::slack);
      if (!band.movable && rigid) at.holds[b] = Hold::slack;
    }
    kkt_.guess_multipliers(at, first_);
    return follow(at);
  }

  bool settled() const { return settled_; }
  int iterations() const { return iteration_; }

 private:
  Load end_load() const {
    Load load;
    for (const Band& band : problem_.bands) {
      load.neutral.push_back(band.neutral);
      load.limit.push_back(std::min(band.tension_limit, kHighestTension));
    }
    load.gravity = problem_.options.gravity;
    return load;
  }

  Load load_at(double share) const {
    Load load = end_load();
    for (std::size_t b = 0; b < bands_; ++b)
      load.neutral[b] = share * load.neutral[b] + (1 - share) * first_.neutral[b];
    load.gravity = share * load.gravity + (1 - share) * first_.gravity;
    return load;
  }

  double first_load_step() const {
    double change = problem_.options.gravity == first_.gravity ? 0 : 4 * kFirstRatioStep;
    for (std::size_t b = 0; b < bands_; ++b)
      change = std::max(change, std::abs(1 - problem_.bands[b].neutral / first_.neutral[b]));
    return change > kFirstRatioStep ? 1 / std::ceil(change / kFirstRatioStep) : 1;
  }

  Outcome follow(Balance at) {
    double share = 0, load_step = first_load_step();
    Balance settled = at;
    while (share < 1 && !stopped_) {
      const double next = std::min(1.0, share + load_step);
      const int before = iteration_;
      if (balance(at, load_at(next), next < 1 ? kOnTheWay : kExact, next < 1 ? kMostPerLoad : kMostAtEnd)) {
        share = next;
        settled = at;
        if (iteration_ - before <= 4) load_step *= 2;
      } else {
        at = settled;
        load_step = std::min(load_step, next - share) / 2;
        if (load_step < kShortestLoadStep) break;
      }
    }
    if (share < 1 && !stopped_) balance(at, load_at(share), kExact, kMostAtEnd);
    return outcome(at, share);
  }

  // Newton's iterations at one load; false where they do not settle.
  bool balance(Balance& at, const Load& load, const Tolerance& tolerance, int most) {
    penalties_ = Eigen::VectorXd::Zero(problem_.volumes.size() + bands_);
    int changes = 0;
    for (int i = 0; i <= most; ++i) {
      Defect defect = kkt_.defect(at, load);
      while (within(defect, tolerance) && change_holds(at, load)) {
        if (++changes > kMostHoldChanges) return false;
        defect = kkt_.defect(at, load);
      }
      if (within(defect, tolerance)) return true;
      if (i == most || iteration_ >= most_iterations_) {
        stopped_ = iteration_ >= most_iterations_;
        return within(defect, kWanted);
      }
      const Step step = kkt_.step(at, load, defect, within(defect, kAtSaddle));
      branch_near_ = branch_near_ || !step.minimum;
      if (!step.move.allFinite() || !step.multipliers.allFinite()) return false;
      if (!advance(at, load, defect, step)) return within(defect, kWanted);
      if (!recorder_.record(++iteration_, at.x, kkt_.defect(at, load).residual)) {
        stopped_ = true;
        return false;
      }
    }
    return false;
  }

  // Line search on energy plus penalties for broken conditions, with a second-order correction of the full
  // step.
  bool advance(Balance& at, const Load& load, const Defect& defect, const Step& step) {
    const Eigen::Index regions = at.pressures.size();
    const auto kept = [&](Eigen::Index i) { return i < regions || at.holds[i - regions] == Hold::length; };
    double slope = defect.gradient.dot(step.move);
    for (Eigen::Index i = 0; i < penalties_.size(); ++i) {
      const double multiplier = i < regions ? at.pressures[i] : at.tensions[i - regions];
      if (kept(i)) {
        penalties_[i] = std::max(penalties_[i], 2 * std::abs(multiplier + step.multipliers[i]));
        slope += multiplier * defect.conditions[i] - penalties_[i] * std::abs(defect.conditions[i]);
      } else {
        slope += defect.conditions[i] * kkt_.gradients().col(i).dot(step.move);
      }
    }
    const auto merit = [&](const Balance& b, const Defect& d) {
      double value = kkt_.energy(b, load);
      for (Eigen::Index i = 0; i < penalties_.size(); ++i)
        if (kept(i)) value += penalties_[i] * std::abs(d.conditions[i]);
      return value;
    };
    const double start = merit(at, defect);
    double longest = 0;
    for (int i = 0; i < problem_.free_nodes; ++i)
      longest = std::max(longest, step.move.segment<3>(3 * i).norm());
    double length = longest > longest_move_ ? longest_move_ / longest : 1;
    for (int halving = 0; halving < 14; ++halving, length /= 2) {
      Balance trial = at;
      move(trial.x, length * step.move);
      trial.pressures += length * step.multipliers.head(regions);
      trial.tensions += length * step.multipliers.tail(bands_);
      Defect there = kkt_.defect(trial, load);
      if (length == 1) {
        Eigen::VectorXd broken = there.conditions;
        for (Eigen::Index i = 0; i < broken.size(); ++i)
          if (!kept(i)) broken[i] = 0;
        move(trial.x, kkt_.correction(broken));
        there = kkt_.defect(trial, load);
      }
      if (merit(trial, there) <= start + 1e-4 * length * std::min(slope, 0.0) + 1e-12 * std::abs(start)) {
        at = trial;
        return true;
      }
    }
    return false;
  }

  void move(Positions& x, const Eigen::VectorXd& by) const {
    for (std::size_t i = 0; i < x.size(); ++i)
      if (problem_.free_index[i] >= 0) x[i] += by.segment<3>(3 * problem_.free_index[i]);
  }

  // Lets go of lines that would push, takes hold of lines that would be too long, and stops at the tension
  // limits.
  bool change_holds(Balance& at, const Load& load) const {
    const double slight = 1e-9 * problem_.force_scale;
    bool changed = false;
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const bool rigid = band.law.kind == TensionLaw::Kind::rigid;
      if (rigid && !band.movable) continue;
      const double length = smooth_length(band, at.x), neutral = load.neutral[b], pull = at.tensions[b];
      Hold hold = at.holds[b];
      if (hold == Hold::length && pull < -slight)
        hold = Hold::slack;
      else if (hold == Hold::slack && length > neutral * (1 + 1e-9))
        hold = Hold::length;
      else if (hold != Hold::limit && pull > load.limit[b] + slight)
        hold = Hold::limit;
      else if (hold == Hold::limit && rigid && length < neutral)
        hold = Hold::length;
      else if (hold == Hold::limit && !rigid &&
               law_tension(band.law, length / neutral) < load.limit[b] - slight)
        hold = Hold::elastic;
      changed = changed || hold != at.holds[b];
      at.holds[b] = hold;
    }
    return changed;
  }

  Outcome outcome(const Balance& at, double share) {
    const Load load = load_at(share);
    const Defect defect = kkt_.defect(at, load);
    settled_ = share == 1 && within(defect, kWanted);
    Outcome result;
    result.state.x = at.x;
    result.iterations = iteration_;
    result.residual = defect.residual;
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const bool stuck =
          !band.movable && band.law.kind == TensionLaw::Kind::rigid && band.neutral < band.initial;
      at_limit_ = at_limit_ || stuck || at.holds[b] == Hold::limit;
      result.state.tensions.push_back(std::max(0.0, at.tensions[b]));
    }
    result.status = !settled_ ? Status::capped : at_limit_ ? Status::infeasible : Status::converged;
    if (branch_near_) result.note = "Another balance was near: the tissue may settle to either side.";
    return result;
  }

  const Problem& problem_;
  Recorder& recorder_;
  Kkt kkt_;
  std::size_t bands_;
  Load first_;
  double longest_move_;
  int iteration_ = 0, most_iterations_;
  bool stopped_ = false, settled_ = false, branch_near_ = false, at_limit_ = false;
  Eigen::VectorXd penalties_;
};

}  // namespace

Outcome find_equilibrium(const Problem& problem, const Solution* start, Recorder& recorder) {
  if (start != nullptr && (start->status == Status::converged || start->status == Status::infeasible)) {
    LoadPath warm(problem, recorder);
    Outcome result = warm.from_solution(*start);
    if (warm.settled()) return result;
  }
  return LoadPath(problem, recorder).from_rest();
}

}  // namespace tensegric_fit::tensegric
