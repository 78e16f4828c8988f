/// Exports on the disk: which there are, and their end.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/status.hpp"
#include "ros/fit_document.hpp"

namespace tensegric_fit::node {

/// Of an export that is not encrypted.
inline constexpr std::array<const char*, 18> kExportFiles = {
    kFitDocument,    "measurements.csv", "body.ply",
    "deformed.ply",  "control.ply",      "control_deformed.ply",
    "front.png",     "side.png",         "distortion.png",
    "fit.glb",       "fit.html",         "body.obj",
    "deformed.obj",  "body.stl",         "deformed.stl",
    "measures.json", "measures.vit",     "measures_worn.vit"};

/// \throw Refusal bad_option: a folder above it is an export, which could then not be deleted as a whole;
/// cannot_write: whether one is cannot be read
void check_in_no_export(const std::string& directory);

/// Folders that are gone.
struct DeletedExports {
  std::vector<std::string> exports;  ///< of the scan that was asked for
  std::vector<std::string> rests;    ///< where writing or deleting was cut off: nobody knows whose they are
};

/// A line each, as answers to `forget` name them.
std::vector<std::string> lines_of(const DeletedExports& deleted);

/// Deletes the exports of that scan: `directory` itself, or the folders in it, at any depth. Links are not
/// followed. `left` is assigned why each other one is not gone: it holds anything else (bad_option), or could
/// not be read or deleted (cannot_write). \throw Refusal bad_option: a relative path, or no scan;
/// nothing_yet: there is no export of it, and nothing was deleted; cannot_write: the directory cannot be
/// looked at
DeletedExports delete_exports(const std::string& directory, const std::string& scan_id,
                              std::vector<geometry::Refusal>& left);

/// Deletes the exports in `directory`, at any depth, whose document was written more than `days` ago. Returns
/// the folders that are gone; what could not be deleted
/// stays and is added to `left`, in words.
std::vector<std::string> delete_old_exports(const std::string& directory, double days,
                                            std::vector<std::string>& left);

}  // namespace tensegric_fit::node
