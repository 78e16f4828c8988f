/// Newton's method at one load: steps, line search, and what each band does (README.md).
#pragma once

#include "tensegric/kkt.hpp"

namespace tensegric_fit::tensegric {

/// How near to balance is near enough; see KktResidual. Tensions are held to the residual's.
struct Tolerance {
  double residual, volume, length;
};
inline constexpr Tolerance kWanted{1e-8, 1e-9,
                                   1e-8};  ///< what counts as balanced (README.md, Exactness: 1e-6 in length)

bool within(const KktResidual& defect, const Tolerance& tolerance);

/// What ended the whole solve before its time.
enum class Stop { none, iterations, time, caller };

class Newton {
 public:
  /// `spent`: iterations of the same solve before it. `most`: with them.
  Newton(const Problem& problem, Recorder& recorder, int spent, int most);

  /// Brings `at` to balance under `load`; false where `most` steps, or all that are left, do not.
  bool settle(Balance& at, const Load& load, const Tolerance& tolerance, int most);

  /// Takes volumes and kept lengths from nearly to wholly right, by the shortest way.
  void mend(Balance& at, const Load& load) const;

  Kkt& kkt() { return kkt_; }
  double longest_move() const { return longest_move_; }
  int iterations() const { return iterations_; }
  Stop stop() const { return stop_; }
  bool branch_near() const { return branch_near_; }  ///< on the way kept, near balance, there was no minimum

 private:
  Stop spent() const;
  bool advance(Balance& at, const Load& load, KktResidual& defect, const Step& step,
               const Tolerance& tolerance);
  bool change_holds_off_balance(Balance& at, const Load& load) const;
  bool release_contradicted(Balance& at, const Load& load, const Step& step) const;
  bool change_holds(Balance& at, const Load& load) const;
  bool is_rounding(const Step& step) const;
  bool is_balance(Balance at, const Load& load, const KktResidual& defect) const;
  void move(Positions& x, const Eigen::VectorXd& by) const;

  const Problem& problem_;
  Recorder& recorder_;
  Kkt kkt_;
  double farthest_ = 0;  // m, largest coordinate at rest
  double longest_move_;  // m, of a node in a step
  int iterations_, most_iterations_, most_factorisations_;
  Stop stop_ = Stop::none;
  bool branch_near_ = false;
  double merit_change_ = 0;    // of the last step, relative
  Eigen::VectorXd penalties_;  // of the merit function, one per condition
};

}  // namespace tensegric_fit::tensegric
