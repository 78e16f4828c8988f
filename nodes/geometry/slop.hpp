/// How far the stamps of one capture's clouds may lie apart: who joins clouds and who follows a capture have
/// to agree on it.
#pragma once

#include <cstdint>

#include "geometry/range.hpp"

namespace tensegric_fit::geometry {

inline constexpr Range kSlop{0, 60};       ///< s
inline constexpr double kUsualSlop = 0.2;  ///< s

/// Of two stamps, ns.
inline std::uint64_t gap(std::uint64_t a, std::uint64_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace tensegric_fit::geometry
