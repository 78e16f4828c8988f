/// Polylines divided evenly. Metres.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

/// `count` points that divide a polyline evenly, its ends not among them. \pre two points or more
std::vector<Eigen::Vector3d> between_ends(const std::vector<Eigen::Vector3d>& line, int count);

/// `count` places evenly along a polyline, both ends among them: its segments, and the shares of their
/// lengths, 0 to 1. \pre two points or more, count >= 2
std::vector<std::pair<std::size_t, double>> even_places(const std::vector<Eigen::Vector3d>& line, int count);

}  // namespace tensegric_fit::geometry
