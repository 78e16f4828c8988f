/// Faster ends for slow fixed-point iterations: Anderson's extrapolation (D. G. Anderson, J. ACM 12, 1965).
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::tensegric {

/// Of an iteration that takes `before` to `after` again and again: where the last few of its moves point to.
class Extrapolation {
 public:
  Extrapolation(Eigen::Index size, int most) : moves_(size, most), afters_(size, most) {}

  /// The state to go on from, in place of `after`.
  Eigen::VectorXd next(const Eigen::VectorXd& before, const Eigen::VectorXd& after);

  /// Forgets what it saw.
  void restart() { seen_ = 0; }

 private:
  Eigen::MatrixXd moves_, afters_;  // differences of successive moves and results, one per column
  Eigen::VectorXd last_move_, last_after_;
  int seen_ = 0;
};

}  // namespace tensegric_fit::tensegric
