/// The axes that makers' programs use.
#pragma once

#include <Eigen/Core>

namespace tensegric_fit::mesh_files {

/// A point of the body frame (x forward, y to her left, z up) in glTF's axes, which are also CLO's: x to her
/// left, y up, z forward. A rotation: triangles keep their outside.
inline Eigen::Vector3d y_up(const Eigen::Vector3d& body) {
  return {body.y(), body.z(), body.x()};
}

}  // namespace tensegric_fit::mesh_files
