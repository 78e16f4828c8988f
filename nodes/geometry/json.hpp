/// Places and motions in JSON.
#pragma once

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace tensegric_fit::geometry {

/// [x, y, z]
inline nlohmann::ordered_json json_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// The four rows of its matrix.
inline nlohmann::ordered_json json_of(const Eigen::Isometry3d& motion) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int r = 0; r < 4; ++r) rows.push_back({motion(r, 0), motion(r, 1), motion(r, 2), motion(r, 3)});
  return rows;
}

}  // namespace tensegric_fit::geometry
