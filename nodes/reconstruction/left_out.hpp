/// What was taken for stray points or for another thing, looked at again once it is known where her limbs
/// are.
#pragma once

#include <vector>

#include "body_model/registered_body.hpp"

namespace tensegric_fit::reconstruction {

/// Indices of the points that lie where the model has skin but the body has no points: sparse limbs.
std::vector<int> points_of_limbs(const std::vector<Eigen::Vector3d>& left_out,
                                 const body_model::RegisteredBody& body);

/// The things among the points that are near her or large: another person, furniture, a limb that nothing
/// joins to her. `body_points`: how many points she has.
std::vector<body_model::Unexplained> things_beside(const std::vector<Eigen::Vector3d>& left_out,
                                                   const body_model::RegisteredBody& body,
                                                   std::size_t body_points);

}  // namespace tensegric_fit::reconstruction
