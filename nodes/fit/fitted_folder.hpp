/// What `fit --garment` wrote, or a pipeline exported, read again.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::fit {

/// Metres, the scan's frame.
struct FittedFolder {
  std::string scan;                       ///< file that the body comes from; of an export: its scan_id
  geometry::TriangleMesh rest;            ///< body.ply
  std::vector<Eigen::Vector3d> deformed;  ///< deformed.ply, one per vertex of `rest`
  geometry::TriangleMesh control;         ///< control.ply
  struct Line {
    std::string name;
    double request, ratio;  ///< asked and reached, over the length at rest
  };
  std::vector<Line> lines;
};

/// \throw Refusal broken_file: a file is not there or not what `fit` writes or exports have; nothing_yet:
/// `fit` refused its scan, or measured without a garment; bad_mesh: bodies before and after that are not of
/// one fit
FittedFolder read_fitted_folder(const std::string& folder);

}  // namespace tensegric_fit::fit
