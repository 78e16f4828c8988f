/// A fit as files, for the garment's maker.
#pragma once

#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/TriangleMesh.h>

#include <string>
#include <vector>

namespace tensegric_fit::node {

/// Everything about the fit of one scan. \pre all of one scan
struct FittedScan {
  TriangleMesh::ConstPtr body;
  Landmarks::ConstPtr landmarks;
  ControlMesh::ConstPtr control;
  FitState::ConstPtr fit;
  DeformedMesh::ConstPtr deformed;
};

/// Writes body.ply, control.ply, control_deformed.ply, deformed.ply (coloured by distortion) and report.json
/// (measurements and fit parameters, with the field names of the `fit` program). They are written into a
/// folder beside `directory` which then takes its name: the export appears whole or not at all, and none is
/// ever overwritten. Returns the files' paths. \throw Refusal bad_option: the path is relative, or there is
/// something already; broken_file: it cannot be written
std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory);

}  // namespace tensegric_fit::node
