/// A fit as files, for the garment's maker.
#pragma once

#include <string>
#include <vector>

#include "ros/fit_figures.hpp"
#include "ros/parameters.hpp"

namespace tensegric_fit::node {

struct ExportOptions {
  bool with_head = false;
  std::string age_recipient = {};  ///< public key; empty: exports are not encrypted
};

/// \throw Refusal bad_option, naming the parameter
ExportOptions export_options(Parameters& parameters);

/// fit.glb: the body with the garment's lines, before and under it (inspect/fit_model.hpp).
std::string fit_model(const FitFigures& figures);

/// Writes fit.json, measurements.csv, body.ply, deformed.ply (coloured by distortion), control.ply,
/// control_deformed.ply, front.png, side.png, distortion.png, fit.glb, fit.html, body and deformed as .obj
/// and .stl, measures.json, measures.vit and measures_worn.vit, as a whole folder: none is ever overwritten.
/// Returns the files' paths. \throw Refusal as write_whole_folder, figures_of, headless and sealed
std::vector<std::string> export_fit(const FittedScan& scan, const std::string& directory,
                                    const ExportOptions& options);

}  // namespace tensegric_fit::node
