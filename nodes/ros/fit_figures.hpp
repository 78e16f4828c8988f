/// What an exported fit says in figures.
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/ScanLabel.h>
#include <tensegric_fit/TriangleMesh.h>

#include <optional>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/control_mesh.hpp"
#include "geometry/fit_warning.hpp"
#include "geometry/moved_skin.hpp"
#include "geometry/triangle_mesh.hpp"
#include "inspect/bra_size.hpp"

namespace tensegric_fit::node {

/// Everything about the fit of one scan. \pre all of one scan
struct FittedScan {
  TriangleMesh::ConstPtr body;
  Landmarks::ConstPtr landmarks;
  ControlMesh::ConstPtr control;
  FitState::ConstPtr fit;
  DeformedMesh::ConstPtr deformed;
  std::vector<geometry::FitWarning> warnings = {};  ///< and notices
  LineForces::ConstPtr forces = nullptr;            ///< null: unknown
  ScanLabel label = {};                             ///< whose it is, as far as anybody said
};

/// The same as core types, and what follows from it. Metres.
struct FitFigures {
  FittedScan scan;
  geometry::TriangleMesh body;
  std::vector<Eigen::Vector3d> deformed;         ///< one per vertex of `body`
  std::vector<Eigen::Vector3d> in_scan_posture;  ///< `deformed`, without the posture in which it is worn
  std::vector<double> distortion;                ///< one per vertex of `body`
  geometry::ControlMesh control;
  std::vector<Eigen::Vector3d> control_deformed;  ///< one per outer node
  geometry::BodyMeasures measures;
  std::vector<geometry::ChangedMeasure> heights, girths;  ///< in the scan's posture
  std::optional<geometry::ChangedMeasure> bust_points;    ///< their distance
  std::vector<inspect::BraSize> sizes;                    ///< bra_sizes of the body before
  bool head = true;                                       ///< false: `body` and what goes with it have none
  std::optional<inspect::BraSize> size_after;             ///< of the girths with the garment on
};

/// \throw Refusal bad_mesh, non_finite: arrays that do not fit each other, or a number that is not finite; as
/// BoneFrames, where the fit is in a posture
FitFigures figures_of(const FittedScan& scan);

}  // namespace tensegric_fit::node
