/// Flat arrays of messages <-> vectors of the cores.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::node {

/// x y z of each point in turn.
template <typename Scalar>
std::vector<Scalar> flat(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Scalar> values;
  values.reserve(3 * points.size());
  for (const Eigen::Vector3d& point : points)
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Scalar>(point[axis]));
  return values;
}

inline constexpr double kFarthest = 1e7;  // m; no map reaches farther

/// \throw Refusal bad_mesh: not a multiple of three, or beyond kFarthest; non_finite
template <typename Scalar>
std::vector<Eigen::Vector3d> points_in(const std::vector<Scalar>& values) {
  if (values.size() % 3 != 0)
    throw geometry::Refusal(geometry::refusal::kBadMesh, "x y z do not come in threes");
  std::vector<Eigen::Vector3d> points;
  points.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3) {
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
    if (!points.back().allFinite())
      throw geometry::Refusal(geometry::refusal::kNonFinite, "a position of the message is not finite");
    if (points.back().cwiseAbs().maxCoeff() > kFarthest)
      throw geometry::Refusal(geometry::refusal::kBadMesh, "a position of the message is 10,000 km away");
  }
  return points;
}

inline std::vector<std::uint32_t> flat(const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<std::uint32_t> values;
  values.reserve(3 * triangles.size());
  for (const Eigen::Vector3i& triangle : triangles)
    for (int corner = 0; corner < 3; ++corner) values.push_back(static_cast<std::uint32_t>(triangle[corner]));
  return values;
}

/// \throw Refusal bad_mesh: not a multiple of three. Numbers above 2^31 turn negative, which check_mesh
/// refuses.
inline std::vector<Eigen::Vector3i> triangles_in(const std::vector<std::uint32_t>& values) {
  if (values.size() % 3 != 0)
    throw geometry::Refusal(geometry::refusal::kBadMesh, "triangles do not come in threes");
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3)
    triangles.emplace_back(static_cast<int>(values[i]), static_cast<int>(values[i + 1]),
                           static_cast<int>(values[i + 2]));
  return triangles;
}

}  // namespace tensegric_fit::node
