/// A fit as files, for the garment's maker.
#pragma once

#include <string>
#include <vector>

#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

/// Writes fit.json, measurements.csv, body.ply, deformed.ply (coloured by distortion), control.ply,
/// control_deformed.ply, front.png, side.png, distortion.png, fit.glb and fit.html, as a whole folder: none
/// is ever overwritten. Returns the files' paths. \throw Refusal as write_whole_folder and figures_of
std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory);

/// Deletes the exports of that scan: `directory` itself, or the folders in it. What is no export, or holds
/// anything else, is left alone. Returns the folders that are gone. \throw Refusal bad_option: a relative
/// path, or no scan; nothing_yet: there is no export of it; cannot_write
std::vector<std::string> delete_exports(const std::string& directory, const std::string& scan_id);

}  // namespace tensegric_fit::node
