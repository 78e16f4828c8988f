/// Which images of cameras that send all the time make one scan.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

namespace tensegric_fit::depth_cameras {

/// `stamps[camera]`, ns, rising: images that each camera sent. Per camera the index of the image that it
/// gives to the scan, kNone where none fits: all chosen ones lie within `slop` ns of each other, of as many
/// cameras as possible, and among those at the earliest moment.
std::vector<int> of_one_moment(const std::vector<std::deque<std::uint64_t>>& stamps, std::uint64_t slop);

inline constexpr int kNone = -1;

}  // namespace tensegric_fit::depth_cameras
