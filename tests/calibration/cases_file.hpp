/// CASES.yaml and PAIRS.yaml: what `calibrate` works on (launch/pages/validation.md).
#pragma once

#include <string>
#include <vector>

#include "calibration/calibration.hpp"

namespace tensegric_fit::calibration {

struct Cases {
  std::vector<CalibrationBody> bodies;  ///< each at each of the file's `meshes`
  std::vector<control_mesh::Template> patterns;
  CalibrationOptions options;
};

/// Scans and worn meshes are read in any unit and axes, a body's own mesh as it is: references number its
/// vertices. `settings`: how bodies are measured. `worn`: for --worn, which itself says what is fitted and at
/// which densities. \throw Refusal bad_option naming file and key: unknown, out of range, not for --worn, or
/// a body's name that is there twice; too_few_data: a body without references; as measure_scan,
/// read_reference and WornReference
Cases read_cases(const std::string& path, const fit::Settings& settings, bool worn);

}  // namespace tensegric_fit::calibration
