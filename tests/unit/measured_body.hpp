/// Meshes and scans measured with the shipped body model, as the product does it.
#pragma once

#include <vector>

#include "body_model/registration.hpp"
#include "landmarks/find_landmarks.hpp"
#include "reconstruction/reconstruct.hpp"

namespace tensegric_fit::test {

/// Of a mesh that was given.
inline geometry::BodyMeasures measured(const geometry::TriangleMesh& mesh) {
  const auto model = body_model::register_mesh(body_model::shipped_registrar(), mesh);
  return landmarks::find_landmarks(mesh, {}, model, landmarks::shipped_precision());
}

inline reconstruction::Reconstruction reconstructed(const geometry::PointCloud& scan,
                                                    const reconstruction::Options& options) {
  const body_model::Registrar& registrar = body_model::shipped_registrar();
  return reconstruction::reconstruct(scan, options, {registrar, registrar.standing()});
}

inline geometry::BodyMeasures measured(const reconstruction::Reconstruction& scanned) {
  return landmarks::find_landmarks(scanned.body.mesh, scanned.body.filled, scanned.model,
                                   landmarks::shipped_precision());
}

}  // namespace tensegric_fit::test
