#include "geometry/parabola.hpp"

#include <Eigen/Cholesky>

namespace tensegric_fit::geometry {

Eigen::Vector3d Parabola::coefficients() const {
  return squares_.ldlt().solve(sums_);
}

}  // namespace tensegric_fit::geometry
