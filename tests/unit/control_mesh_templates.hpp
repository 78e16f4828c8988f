/// Shipped templates, for the tests of the control mesh.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit {

inline const std::string kTemplates = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/templates/";
inline const std::string kBust = kTemplates + "bust.yaml", kHips = kTemplates + "hips.yaml";

inline Eigen::Vector3d area_of(const std::vector<Eigen::Vector3d>& nodes, const Eigen::Vector3i& t) {
  return geometry::area_vector(nodes[t[0]], nodes[t[1]], nodes[t[2]]);
}

}  // namespace tensegric_fit
