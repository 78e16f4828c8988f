/// What a person stands on where that is not the floor.
#pragma once

#include <optional>

#include "body_model/registered_body.hpp"
#include "body_model/standing.hpp"
#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

/// m: what lies less than that over the floor is no plate, but how far soles and floor are known. On floors
/// that were seen the model's soles are within 4 mm of them (9 training women), and a plate's top is as near.
/// Of a foot that is tilted the lowest place may be half as high.
inline constexpr double kThinnestPlate = 0.015;

struct Plate {
  double top;    ///< m over the floor
  double noise;  ///< standard deviation of its points, m
};

/// The plate or turntable under both feet, whose top is seen round them; none where she stands on the floor,
/// on heels, or with a foot lifted. \pre the floor at z = 0, upright, with outward normals
std::optional<Plate> find_plate(const geometry::PointCloud& cloud, const body_model::RegisteredBody& model,
                                const body_model::Standing& standing);

}  // namespace tensegric_fit::reconstruction
