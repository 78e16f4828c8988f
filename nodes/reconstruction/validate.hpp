/// What a scan must be before anything is built on it.
#pragma once

#include <optional>

#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"
#include "reconstruction/reconstruct.hpp"

namespace tensegric_fit::reconstruction {

/// \throw Refusal bad_option naming the field
void check_options(const Options& options);

/// The finite points of a scan that lie within reach of a booth; a normal that is not a unit vector becomes
/// zero. \throw Refusal empty_cloud, non_finite (no point is finite), too_few_points, too_many_points,
/// wrong_unit, not_a_body (all in one place), wrong_fields (normals for some points only)
geometry::PointCloud usable_points(const geometry::PointCloud& scan, const Options& options);

/// Coarse plausibility of an upright body's points, z up: too_few_points, not_a_body, or nothing. Finer
/// judgement is left to the landmarks.
std::optional<geometry::Refusal> fault_of_shape(const std::vector<Eigen::Vector3d>& body,
                                                const Options& options);

}  // namespace tensegric_fit::reconstruction
