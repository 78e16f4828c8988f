/// What a person stands on where that is not the floor.
#pragma once

#include <optional>

#include "body_model/registered_body.hpp"
#include "body_model/standing.hpp"
#include "geometry/point_cloud.hpp"

namespace tensegric_fit::reconstruction {

struct Plate {
  double top;    ///< m over the floor
  double noise;  ///< standard deviation of its points, m
};

/// The plate or turntable under both feet, whose top is seen round them; none where she stands on the floor,
/// on heels, or with a foot lifted. \pre the floor at z = 0, upright, with outward normals
std::optional<Plate> find_plate(const geometry::PointCloud& cloud, const body_model::RegisteredBody& model,
                                const body_model::Standing& standing);

}  // namespace tensegric_fit::reconstruction
