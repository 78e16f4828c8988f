/// Messages of the body and of its control mesh <-> core types.
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/fracture.hpp"
#include "geometry/posture.hpp"
#include "geometry/triangle_mesh.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// `filled` is empty or has one flag per vertex. Coordinates are rounded to float32.
TriangleMesh to_message(const ScanTag& tag, const geometry::TriangleMesh& mesh,
                        const std::vector<char>& filled);

/// \throw Refusal bad_mesh, non_finite: no triangles, arrays that do not fit each other, as check_mesh
geometry::TriangleMesh mesh_in(const TriangleMesh& message);

/// One flag per vertex, or empty. \throw Refusal bad_mesh: another number of flags
std::vector<char> filled_in(const TriangleMesh& message);

Fracture to_message(const geometry::Fracture& fracture);
std::vector<geometry::Fracture> fractures_in(const TriangleMesh& message);

Landmarks to_message(const ScanTag& tag, const geometry::BodyMeasures& measures);

/// \throw Refusal non_finite, bad_mesh: a transform that is not rigid, more entries than any body has
geometry::BodyMeasures measures_in(const Landmarks& message);

/// \throw Refusal bad_mesh: more lines, or points of their courses, than any garment has
void check_lines(const FitState& fit);

/// The posture in which a fit is worn. \throw Refusal as BoneFrames
geometry::BoneFrames bones_of(const FitState& fit, const geometry::BodyMeasures& measures);

ControlMesh to_message(const ScanTag& tag, const geometry::ControlMesh& control);

/// \throw Refusal bad_mesh, non_finite, as check_control_mesh
geometry::ControlMesh control_in(const ControlMesh& message);

}  // namespace tensegric_fit::node
