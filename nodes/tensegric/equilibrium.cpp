#include "tensegric/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tensegric/band_length.hpp"
#include "tensegric/newton.hpp"
#include "tensegric/shape_check.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr Tolerance kExact{1e-10, 1e-12, 1e-11};  // what is aimed at
constexpr Tolerance kOnTheWay{0.2, 1e-4, 1e-4};   // at a load between rest and the request
constexpr double kShareOfWeight = 0.01;           // residual on the way, of the change in gravity
constexpr double kFirstRatioStep = 0.1;  // change of a neutral length in the first load step, relative
constexpr int kQuick = 2;                // iterations of a load step after which the next is twice as long
constexpr double kShortestLoadStep = 1.0 / 1024;
constexpr double kTrue = 1e-6;       // of a length: README.md, Exactness
constexpr double kSamePlace = 1e-9;  // m
// What is handed back of an unfinished way: pulls that are left over are below the tissue's own.
constexpr Tolerance kHandedBack{1, 1e-9, 1};
constexpr double kNearFold = 0.002;  // of a line's length: a millimetre of a chest
constexpr int kMostPerLoad = 60, kMostAtEnd = 80, kMostCorrections = 10;
constexpr int kMostGoBack = 2;                       // halvings of the way to a shape that is tried
constexpr int kMostFromRest = 300, kMostWarm = 100;  // a start that leads nowhere soon is dropped
// Under a weight a shape may buckle and go over to another balance, by up to twice its length in steps of
// half a part's length at most: 100 to 200 of them, whatever the load steps.
constexpr int kMostWhileBuckling = 300, kMostUnderWeight = 1200;

std::string per_cent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

class LoadPath {
 public:
  /// `spent`: iterations before it. `most`: with them.
  LoadPath(Problem& problem, Recorder& recorder, int spent, int most)
      : problem_(problem),
        recorder_(recorder),
        newton_(problem, recorder, spent, most),
        bands_(problem.bands.size()) {}

  Outcome from_rest() { return follow(start_of_way()); }

  Outcome from_solution(const Solution& start) {
    Balance at{positions_of(start),
               Eigen::VectorXd::Zero(problem_.volumes.size()),
               Eigen::VectorXd::Zero(bands_),
               {}};
    first_ = end_load();
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const double length = smooth_length(band, at.x);
      first_.neutral[b] = band.steep ? std::max(length, band.neutral) : length;
      for (const LineResult& line : start.lines) {
        if (line.name != band.name || line.tension <= 0) continue;
        first_.neutral[b] = line.neutral;
        at.tensions[b] = line.tension;
      }
      at.holds.push_back(!band.steep                                   ? Hold::elastic
                         : at.tensions[b] >= first_.limit[b]           ? Hold::limit
                         : at.tensions[b] > 0 || length > band.neutral ? Hold::length
                                                                       : Hold::slack);
      if (band.steep && !can_hold(band)) at.holds[b] = Hold::slack;
    }
    first_posture_ = 1;
    warm_ = true;
    carry(at.x, 1, 1);
    newton_.kkt().guess_multipliers(at, first_);
    return follow(at);
  }

  bool settled() const { return settled_; }
  int iterations() const { return newton_.iterations(); }
  /// By the caller, or a bound that the caller set.
  bool interrupted() const {
    const int most = problem_.options.max_iterations;
    return stopped() && (newton_.stop() != Stop::iterations || (most > 0 && iterations() >= most));
  }

 private:
  bool stopped() const { return newton_.stop() != Stop::none; }

  // A rigid line over fixed nodes only has nothing to pull.
  static bool can_hold(const Band& band) { return band.movable || band.law.kind != TensionLaw::Kind::rigid; }

  // Where the way from rest begins.
  Balance at_rest() {
    Balance at{
        problem_.rest, Eigen::VectorXd::Zero(problem_.volumes.size()), Eigen::VectorXd::Zero(bands_), {}};
    first_ = end_load();
    for (std::size_t b = 0; b < bands_; ++b) {
      first_.neutral[b] = problem_.bands[b].initial;
      at.holds.push_back(problem_.bands[b].steep ? Hold::slack : Hold::elastic);
    }
    first_.gravity.setZero();
    first_posture_ = 0;
    return at;
  }

  // Rest, with the lines that are to be shortened kept at their lengths.
  Balance start_of_way() {
    Balance at = at_rest();
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      if (band.steep && band.neutral < band.initial && can_hold(band)) at.holds[b] = Hold::length;
    }
    return at;
  }

  Load end_load() const {
    Load load;
    for (const Band& band : problem_.bands) {
      load.neutral.push_back(band.neutral);
      load.limit.push_back(hold_limit(problem_, band));
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

  double posture_at(double share) const { return share + (1 - share) * first_posture_; }

  // A light weight that bends a long shape far is less than what would do on the way to a line's length.
  Tolerance on_the_way() const {
    Tolerance tolerance = kOnTheWay;
    const double weight = (problem_.options.gravity - first_.gravity).norm() / problem_.force_scale;
    if (weight > 0) tolerance.residual = std::min(tolerance.residual, kShareOfWeight * weight);
    return tolerance;
  }

  // Of neutral lengths over the whole way, relative.
  double length_change() const {
    double change = 0;
    for (std::size_t b = 0; b < bands_; ++b)
      change = std::max(change, std::abs(1 - problem_.bands[b].neutral / first_.neutral[b]));
    return change;
  }

  double first_load_step() const {
    double change = problem_.options.gravity == first_.gravity ? 0 : 4 * kFirstRatioStep;
    change = std::max(change, length_change());
    const Positions before = posed(problem_, first_posture_), after = posed(problem_, 1);
    for (std::size_t i = 0; i < before.size(); ++i)
      change = std::max(change, kFirstRatioStep * (after[i] - before[i]).norm() / newton_.longest_move());
    const double steps =
        std::ceil(change / kFirstRatioStep - 1e-9);  // a request of 0.90 is one, rounded or not
    return steps > 1 ? 1 / steps : 1;
  }

  int most_at(double share) const {
    if (!problem_.options.gravity.isZero(0)) return kMostWhileBuckling;
    return share < 1 ? kMostPerLoad : kMostAtEnd;
  }

  // Takes the nodes that are not solved for to where the posture has them, and what is free above
  // bound inner nodes along.
  void carry(Positions& x, double from, double to) {
    const Positions before = posed(problem_, from), after = posed(problem_, to);
    const std::size_t outer = problem_.model.control.outer.size();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (problem_.free_index[i] < 0)
        x[i] = after[i];
      else if (problem_.free_index[outer + i % outer] < 0)
        x[i] += after[outer + i % outer] - before[outer + i % outer];
    }
    pose_problem(problem_, to);
  }

  Outcome follow(Balance at) {
    double share = 0, load_step = first_load_step();
    Balance settled = at;
    while (share < 1 && !stopped()) {
      const double next = std::min(1.0, share + load_step);
      const int before = newton_.iterations();
      carry(at.x, posture_at(share), posture_at(next));
      if (newton_.settle(at, load_at(next), next < 1 ? on_the_way() : kExact, most_at(next))) {
        share = next;
        settled = at;
        if (newton_.iterations() - before <= kQuick) load_step *= 2;
      } else {
        at = settled;
        load_step = std::min(load_step, next - share) / 2;
        if (load_step < kShortestLoadStep) break;
      }
    }
    folded_ = skin_folds(problem_, at.x);
    if (folded_ && goes_back()) {
      if (!warm_) share = go_back(at, share);
      return outcome(at, load_at(share), share, !warm_ && !stopped());
    }
    Load load = load_at(share);
    bool true_lengths = true;
    if (share == 1) {
      true_lengths = make_true(at, load);
    } else {
      carry(at.x, posture_at(share), posture_at(share));
      if (stopped() || !newton_.settle(at, load, kExact, kMostAtEnd)) at = settled;
      newton_.mend(at, load);
      if (!within(newton_.kkt().defect(at, load), kHandedBack)) {
        at = at_rest();
        pose_problem(problem_, 0);
        share = 0;
        load = load_at(share);
      }
    }
    return outcome(at, load, share, true_lengths);
  }

  // The load is the garment's alone: a part of it is a looser garment.
  bool goes_back() const { return problem_.options.bones.still() && problem_.options.gravity.isZero(0); }

  // From one share of the load to another, in halves where it does not settle at once.
  bool settle_between(Balance& at, double from, double to, int halvings) {
    const Balance start = at;
    if (newton_.settle(at, load_at(to), kExact, kMostPerLoad)) return true;
    at = start;
    const double middle = (from + to) / 2;
    return halvings > 0 && !stopped() && settle_between(at, from, middle, halvings - 1) &&
           settle_between(at, middle, to, halvings - 1);
  }

  // From rest to the farthest share of the way, but for kNearFold of a line, where no skin is turned over.
  // `share`: where it is.
  double go_back(Balance& at, double share) {
    double smooth = 0;
    at = start_of_way();
    while ((share - smooth) * length_change() > kNearFold && !stopped()) {
      const double middle = (smooth + share) / 2;
      Balance next = at;
      if (settle_between(next, smooth, middle, kMostGoBack) && !skin_folds(problem_, next.x)) {
        smooth = middle;
        at = next;
      } else {
        share = middle;
      }
    }
    recorder_.record(newton_.iterations(), at.x, newton_.kkt().defect(at, load_at(smooth)).residual);
    return smooth;
  }

  // Where a segment is shorter than the smooth length resolves, the neutral lengths are moved by as much as
  // it is off, so that the polyline's own length is what was asked for. False where it is not, in the end.
  bool make_true(Balance& at, Load& load) {
    for (int i = 0;; ++i) {
      double off = 0;
      Load wanted = load;
      for (std::size_t b = 0; b < bands_; ++b) {
        const Band& band = problem_.bands[b];
        const double length = length_of(band, at.x);
        const bool kept = at.holds[b] == Hold::length && band.law.kind == TensionLaw::Kind::rigid;
        wanted.neutral[b] = kept ? load.neutral[b] + (band.neutral - length) * smooth_slope(band, at.x)
                                 : band.neutral * smooth_length(band, at.x) / length;
        off = std::max(off,
                       std::abs(kept ? length / band.neutral - 1 : wanted.neutral[b] / load.neutral[b] - 1));
      }
      if (off <= kWanted.length) return true;
      Balance truer = at;
      if (i == kMostCorrections || stopped() || !newton_.settle(truer, wanted, kExact, kMostAtEnd))
        return off <= kTrue;
      at = truer;
      load = wanted;
    }
  }

  Outcome outcome(const Balance& at, const Load& load, double share, bool true_lengths) {
    const KktResidual defect = newton_.kkt().defect(at, load);
    settled_ = (share == 1 || (folded_ && goes_back())) && true_lengths && within(defect, kWanted);
    Outcome result;
    result.state.x = at.x;
    result.iterations = newton_.iterations();
    result.residual = defect.residual;
    result.neutral = load.neutral;
    bool at_limit = false;
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const bool stuck = !can_hold(band) && length_of(band, at.x) > band.neutral * (1 + kTrue);
      at_limit = at_limit || stuck || at.holds[b] == Hold::limit;
      result.state.tensions.push_back(at.holds[b] == Hold::slack ? 0 : std::max(0.0, at.tensions[b]));
    }
    result.status = !settled_ ? Status::capped : at_limit || folded_ ? Status::infeasible : Status::converged;
    if (!settled_)
      result.note = why_stopped() + ": this is the last balance " +
                    (warm_ ? "that was found." : "on the way, at " + per_cent(share) + " of the request.");
    else if (folded_)
      result.note = share < 1 ? "Further on skin would turn over: this is the last smooth shape, at " +
                                    per_cent(share) + " of the request."
                              : kSkinTurnsOver;
    else if (newton_.branch_near())
      result.note = "Another balance was near: the tissue may settle to either side.";
    return result;
  }

  std::string why_stopped() const {
    switch (newton_.stop()) {
      case Stop::time:
        return "The time budget ended";
      case Stop::iterations:
        return "The iterations ended";
      case Stop::caller:
        return "The solution was cancelled";
      case Stop::none:
        break;
    }
    return "No balance was found further on";
  }

  Problem& problem_;
  Recorder& recorder_;
  Newton newton_;
  std::size_t bands_;
  Load first_;
  double first_posture_ = 0;
  bool settled_ = false;
  bool warm_ = false;    // from an earlier solution
  bool folded_ = false;  // skin is turned over where the request was, or the balances ended
};

// Without load and with lines as long as at rest, rest is the balance.
bool is_rest_asked_for(const Problem& problem) {
  return problem.options.gravity.isZero(0) && problem.options.bones.still() &&
         std::all_of(problem.bands.begin(), problem.bands.end(),
                     [](const Band& band) { return band.neutral >= band.initial; });
}

// A solution in another posture is not a start.
bool is_start(const Problem& problem, const Solution& start) {
  if (start.status != Status::converged && start.status != Status::infeasible) return false;
  const Positions x = positions_of(start), target = posed(problem, 1);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (is_held(problem, static_cast<int>(i)) && (x[i] - target[i]).norm() > kSamePlace) return false;
  return std::isfinite(fold_energy(problem.units, x));
}

// `spent`: iterations of the same solve before it.
Outcome find_balance(Problem& problem, const Solution* start, Recorder& recorder, int spent) {
  const int allowed = problem.options.max_iterations;
  if (start != nullptr && is_start(problem, *start) && !is_rest_asked_for(problem)) {
    const int most = spent + kMostWarm;
    LoadPath warm(problem, recorder, spent, allowed > 0 ? std::min(allowed, most) : most);
    Outcome result = warm.from_solution(*start);
    if (warm.settled() || warm.interrupted()) return result;
    spent = warm.iterations();
  }
  const int most = problem.options.gravity.isZero(0) ? kMostFromRest : kMostUnderWeight;
  return LoadPath(problem, recorder, spent, allowed > 0 ? allowed : spent + most).from_rest();
}

// The names of the regions that have nodes to be solved for.
std::string moving_regions(const Problem& problem) {
  const auto moves = [&problem](const Eigen::Vector3i& t) {
    return problem.free_index[t[0]] >= 0 || problem.free_index[t[1]] >= 0 || problem.free_index[t[2]] >= 0;
  };
  std::string names;
  for (const RegionVolume& region : problem.volumes)
    if (std::any_of(region.triangles.begin(), region.triangles.end(), moves))
      names += (names.empty() ? "" : ", ") + region.name;
  return names;
}

// What nothing joins is worn apart, so that one piece does not depend on what is worn on another.
Outcome find_balances(const Problem& problem, const std::vector<std::vector<int>>& separate,
                      const Solution* start, Recorder& recorder) {
  std::vector<Problem> parts;
  for (const std::vector<int>& bands : separate) parts.push_back(with_bands(problem, bands));
  Outcome all;
  all.status = Status::converged;
  all.state = {problem.rest, std::vector<double>(problem.bands.size(), 0)};
  all.neutral.resize(problem.bands.size());
  if (start != nullptr)
    for (const Problem& part : parts)
      all.state.x = merged(all.state.x, positions_of(*start), part.free_index);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    recorder.look_at(parts[p].free_index, all.state.x);
    const Outcome part = find_balance(parts[p], start, recorder, all.iterations);
    all.state.x = merged(all.state.x, part.state.x, parts[p].free_index);
    for (std::size_t b = 0; b < separate[p].size(); ++b) {
      all.state.tensions[separate[p][b]] = part.state.tensions[b];
      all.neutral[separate[p][b]] = part.neutral[b];
    }
    all.status = std::max(all.status, part.status);
    all.iterations = part.iterations;
    all.residual = std::max(all.residual, part.residual);
    if (part.note.empty()) continue;
    const std::string regions = moving_regions(parts[p]);
    all.note += (all.note.empty() ? "" : " ") + (regions.empty() ? "" : "In " + regions + ": ") + part.note;
  }
  recorder.look_at({}, {});
  return all;
}

}  // namespace

Outcome find_equilibrium(Problem& problem, const Solution* start, Recorder& recorder) {
  const std::vector<std::vector<int>> separate = separate_bands(problem);
  if (separate.size() <= 1) return find_balance(problem, start, recorder, 0);
  const Outcome apart = find_balances(problem, separate, start, recorder);
  // Skin between two pieces may follow both, and turn over though it does under neither of them alone.
  if (apart.status > Status::infeasible || !skin_folds(problem, apart.state.x)) return apart;
  return find_balance(problem, start, recorder, apart.iterations);
}

}  // namespace tensegric_fit::tensegric
