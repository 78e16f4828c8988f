/// The reach of t-FFD's triangles: who lays bands on the skin and who carries the skin have to agree on it.
#pragma once

#include "geometry/range.hpp"

namespace tensegric_fit::geometry {

/// In a triangle's mean radii; 0 stands for the setting's own. Below 1 the local kernels leave gaps between
/// the triangles; far above, every triangle carries everything.
inline constexpr Range kBeta{1, 20}, kBetaOrNone{0, kBeta.high};

/// \throw Refusal bad_option: neither 0 nor in the range
inline void check_beta(double beta) {
  if (beta != 0) check_option("beta", beta, kBeta);
}

}  // namespace tensegric_fit::geometry
