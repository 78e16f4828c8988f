/// The reach of t-FFD's triangles: who lays bands on the skin and who carries the skin have to agree on it.
#pragma once

#include "geometry/range.hpp"

namespace tensegric_fit::geometry {

/// In a triangle's mean radii; 0 stands for the setting's own. Below 1 the local kernels leave gaps between
/// the triangles; far above, every triangle carries everything.
inline constexpr geometry::Range kBeta{1, 20};

}  // namespace tensegric_fit::geometry
