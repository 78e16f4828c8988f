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

/// The polyline in steps of `step` metres from its first point, to the end of the segment in which `length`
/// is reached. \pre two points or more
std::vector<Eigen::Vector3d> even_steps(const std::vector<Eigen::Vector3d>& line, double step, double length);

/// A closed loop by the first `harmonics` of its `count` even steps (elliptic Fourier descriptors; Kuhl and
/// Giardina 1982): a tape round the loop itself would lie on its noise. \pre three points or more
std::vector<Eigen::Vector3d> first_harmonics(std::vector<Eigen::Vector3d> loop, int harmonics, int count);

}  // namespace tensegric_fit::geometry
