/// How far the stamps of one capture's clouds may lie apart: who joins clouds and who follows a capture have
/// to agree on it.
#pragma once

#include "geometry/range.hpp"

namespace tensegric_fit::geometry {

inline constexpr Range kSlop{0, 60};       ///< s
inline constexpr double kUsualSlop = 0.2;  ///< s

}  // namespace tensegric_fit::geometry
