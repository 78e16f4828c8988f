#include "tensegric/rank_update.hpp"

#include <algorithm>

// The compiler makes two versions, and the loader takes the one that fits the processor: not with clang,
// which fuzz targets are built with, nor under sanitizers, which are not ready by then.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define TENSEGRIC_FIT_FOR_EACH_PROCESSOR __attribute__((target_clones("avx2", "default")))
#else
#define TENSEGRIC_FIT_FOR_EACH_PROCESSOR
#endif

namespace tensegric_fit::tensegric {
namespace {

// Four numbers side by side, wherever they lie.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
constexpr Eigen::Index kColumns = 4;  // of a tile, whose sums stay in registers with AVX2

struct Panel {
  const double* data;
  Eigen::Index stride;
};

TENSEGRIC_FIT_FOR_EACH_PROCESSOR
void subtract(const Panel a, const Panel b, Eigen::Index terms, Eigen::Index rows, double* lower,
              Eigen::Index stride) {
  for (Eigen::Index i = 0; i < rows; i += kTileRows) {
    const Eigen::Index columns = std::min(i + kTileRows, rows);
    for (Eigen::Index j = 0; j < columns; j += kColumns) {
      Four sums[kColumns][2] = {};
      for (Eigen::Index k = 0; k < terms; ++k) {
        const double* column = a.data + i + k * a.stride;
        const double* row = b.data + j + k * b.stride;
        const Four above = *reinterpret_cast<const Four*>(column);
        const Four below = *reinterpret_cast<const Four*>(column + 4);
        for (Eigen::Index c = 0; c < kColumns; ++c) {
          sums[c][0] += above * row[c];
          sums[c][1] += below * row[c];
        }
      }
      double* tile = lower + i + j * stride;
      if (i + kTileRows <= rows && j + kColumns <= rows) {
        for (Eigen::Index c = 0; c < kColumns; ++c) {
          *reinterpret_cast<Four*>(tile + c * stride) -= sums[c][0];
          *reinterpret_cast<Four*>(tile + c * stride + 4) -= sums[c][1];
        }
        continue;
      }
      for (Eigen::Index c = 0; c < std::min(kColumns, rows - j); ++c)
        for (Eigen::Index r = 0; r < std::min(kTileRows, rows - i); ++r)
          tile[r + c * stride] -= sums[c][r / 4][r % 4];
    }
  }
}

}  // namespace

void subtract_product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                      Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> lower) {
  subtract({a.data(), a.outerStride()}, {b.data(), b.outerStride()}, a.cols(), lower.rows(), lower.data(),
           lower.outerStride());
}

}  // namespace tensegric_fit::tensegric
