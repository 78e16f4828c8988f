/// The body under a garment, bound to its control mesh by t-FFD.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tensegric/body_under_garment.hpp"
#include "tffd/binding.hpp"
#include "tffd/lay_line.hpp"

namespace tensegric_fit::fit {

/// A garment's line as it lies on the body. \throw Refusal unknown_line: a node that the control mesh lacks
tffd::LineOnBody on_body(const geometry::ControlMesh& control, const tensegric::GarmentLine& line);

/// The line laid on the body that was bound. `way`: as on_body. \throw Refusal as tffd::lay_line, with the
/// line's name
std::vector<geometry::Fibre> lay(const tensegric::GarmentLine& line, const tffd::LineOnBody& way,
                                 const geometry::TriangleMesh& body, const tffd::Binding& binding);

/// One per region: the volume under its triangles of the body, metres and m^3.
/// `binding`: not posed; `carried`: as tffd::carried_triangles; `bones`: of the posture, still or not
std::vector<tensegric::PosedVolume> body_volumes(const tffd::Binding& binding,
                                                 const std::vector<std::vector<Eigen::Vector3i>>& carried,
                                                 const geometry::ControlMesh& control,
                                                 const geometry::BoneFrames& bones);

/// Whether the body's skin is turned over where its control nodes are here. \pre the nodes are the binding's
bool skin_folds(const tffd::Binding& binding, const std::vector<Eigen::Vector3i>& triangles,
                const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner);

/// A tensegric::BindBody: `body` is called and bound when it is first asked for anything.
/// Lines stay laid while they are asked for: a change of ratio does not move them.
std::unique_ptr<const tensegric::BodyUnderGarment> bind_body(std::function<geometry::TriangleMesh()> body,
                                                             const geometry::ControlMesh& control,
                                                             const geometry::BoneFrames& bones, double beta);

}  // namespace tensegric_fit::fit
