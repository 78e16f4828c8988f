#include "tensegric/extrapolation.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace tensegric_fit::tensegric {

Eigen::VectorXd Extrapolation::next(const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
  const Eigen::VectorXd move = after - before;
  const auto most = static_cast<int>(moves_.cols());
  if (seen_ > 0) {
    moves_.col((seen_ - 1) % most) = move - last_move_;
    afters_.col((seen_ - 1) % most) = after - last_after_;
  }
  const int columns = std::min(seen_, most);
  ++seen_;
  last_move_ = move;
  last_after_ = after;
  if (columns == 0) return after;
  const Eigen::VectorXd shares = moves_.leftCols(columns).colPivHouseholderQr().solve(move);
  return after - afters_.leftCols(columns) * shares;
}

}  // namespace tensegric_fit::tensegric
