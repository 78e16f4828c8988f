/// The dense update on which most of a factorisation's time goes.
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::tensegric {

/// lower -= a b^T, on the diagonal and below; what stands above it is left in any state. Twice as fast as
/// Eigen's product where the processor has AVX2, of which Debian's packages make no use, and the same to the
/// bit where it has not: each entry's terms are added in the order of a's columns.
/// \pre lower is square, a and b have its rows
void subtract_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                      Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> lower);

}  // namespace tensegric_fit::tensegric
