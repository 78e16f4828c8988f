/// How large a scan may be.
#pragma once

#include "geometry/range.hpp"

namespace tensegric_fit::geometry {

/// m, the longest extent. No booth is larger. The lower bound is a tolerance: a body of 2.2 m that was scaled
/// as if it were in inches has 0.06 m, in cm and mm less, and the smallest scans that are measured, of a
/// bust, have 0.4 m.
inline constexpr Range kScanExtent{0.1, 8};

/// m, from the origin of a scan's frame: messages have coordinates of single precision, a millimetre apart
/// here.
inline constexpr double kFarthestFromOrigin = 1e4;

}  // namespace tensegric_fit::geometry
