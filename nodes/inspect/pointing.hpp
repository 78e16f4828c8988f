/// Where someone points at on the skin.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface_tree.hpp"

namespace tensegric_fit::inspect {

/// The first place of the skin that a ray meets from outside; nothing where it meets none. \pre the triangles
/// index the vertices
std::optional<geometry::SurfacePoint> first_hit(const std::vector<Eigen::Vector3d>& vertices,
                                                const std::vector<Eigen::Vector3i>& triangles,
                                                const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& direction);

/// A value of the vertices there.
double value_at(const geometry::SurfacePoint& place, const std::vector<Eigen::Vector3i>& triangles,
                const std::vector<double>& values);

/// A name for people: "bust_point_L" is "left bust point".
std::string spoken(const std::string& landmark);

}  // namespace tensegric_fit::inspect
