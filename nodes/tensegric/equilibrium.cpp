#include "tensegric/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "tensegric/newton.hpp"

namespace tensegric_fit::tensegric {
namespace {

constexpr Tolerance kExact{1e-10, 1e-12, 1e-11};  // what is aimed at
constexpr Tolerance kOnTheWay{5e-2, 1e-4, 1e-4};  // at a load between rest and the request
constexpr double kHighestTension = 20;            // where a rigid line has no limit of its own; times k
constexpr double kFirstRatioStep = 0.03;  // change of a neutral length in the first load step, relative
constexpr double kShortestLoadStep = 1.0 / 1024;
constexpr int kMostPerLoad = 30, kMostAtEnd = 80, kMostCorrections = 10;

class LoadPath {
 public:
  LoadPath(const Problem& problem, Recorder& recorder)
      : problem_(problem), newton_(problem, recorder), bands_(problem.bands.size()) {}

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
    Balance at{positions_of(start),
               Eigen::VectorXd::Zero(problem_.volumes.size()),
               Eigen::VectorXd::Zero(bands_),
               {}};
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
    newton_.kkt().guess_multipliers(at, first_);
    return follow(at);
  }

  bool settled() const { return settled_; }
  bool stopped() const { return newton_.stopped(); }

 private:
  Load end_load() const {
    Load load;
    for (const Band& band : problem_.bands) {
      load.neutral.push_back(band.neutral);
      const bool unlimited = band.law.kind == TensionLaw::Kind::rigid && std::isinf(band.tension_limit);
      load.limit.push_back(unlimited ? kHighestTension : band.tension_limit);
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
    while (share < 1 && !newton_.stopped()) {
      const double next = std::min(1.0, share + load_step);
      const int before = newton_.iterations();
      if (newton_.settle(at, load_at(next), next < 1 ? kOnTheWay : kExact,
                         next < 1 ? kMostPerLoad : kMostAtEnd)) {
        share = next;
        settled = at;
        if (newton_.iterations() - before <= 4) load_step *= 2;
      } else {
        at = settled;
        load_step = std::min(load_step, next - share) / 2;
        if (load_step < kShortestLoadStep) break;
      }
    }
    Load load = load_at(share);
    if (share < 1 && !newton_.stopped()) newton_.settle(at, load, kExact, kMostAtEnd);
    if (share == 1) make_true(at, load);
    return outcome(at, load, share);
  }

  // Where a segment is shorter than the smooth length can tell, the neutral lengths are moved by as much as
  // it is off, so that the polyline's own length is what was asked for.
  void make_true(Balance& at, Load& load) {
    for (int i = 0; i < kMostCorrections && !newton_.stopped(); ++i) {
      double off = 0;
      for (std::size_t b = 0; b < bands_; ++b) {
        const Band& band = problem_.bands[b];
        const double wanted =
            band.neutral * smooth_length(band, at.x) / geometry::line_length(band.nodes, at.x);
        off = std::max(off, std::abs(wanted / load.neutral[b] - 1));
        load.neutral[b] = wanted;
      }
      if (off <= kWanted.length || !newton_.settle(at, load, kExact, kMostAtEnd)) return;
    }
  }

  Outcome outcome(const Balance& at, const Load& load, double share) {
    const Defect defect = newton_.kkt().defect(at, load);
    settled_ = share == 1 && within(defect, kWanted);
    Outcome result;
    result.state.x = at.x;
    result.iterations = newton_.iterations();
    result.residual = defect.residual;
    for (std::size_t b = 0; b < bands_; ++b) {
      const Band& band = problem_.bands[b];
      const bool stuck =
          !band.movable && band.law.kind == TensionLaw::Kind::rigid && band.neutral < band.initial;
      at_limit_ = at_limit_ || stuck || at.holds[b] == Hold::limit;
      result.state.tensions.push_back(at.holds[b] == Hold::slack ? 0 : std::max(0.0, at.tensions[b]));
    }
    result.status = !settled_ ? Status::capped : at_limit_ ? Status::infeasible : Status::converged;
    if (newton_.branch_near())
      result.note = "Another balance was near: the tissue may settle to either side.";
    return result;
  }

  const Problem& problem_;
  Newton newton_;
  std::size_t bands_;
  Load first_;
  bool settled_ = false, at_limit_ = false;
};

}  // namespace

Outcome find_equilibrium(const Problem& problem, const Solution* start, Recorder& recorder) {
  if (start != nullptr && (start->status == Status::converged || start->status == Status::infeasible)) {
    LoadPath warm(problem, recorder);
    Outcome result = warm.from_solution(*start);
    if (warm.settled() || warm.stopped()) return result;
  }
  return LoadPath(problem, recorder).from_rest();
}

}  // namespace tensegric_fit::tensegric
