/// Fits the tissue's parameters to reference displacements (P2 §6: the model's parameters can be adjusted
/// where it is correlated with a real object).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/reference_field.hpp"
#include "fit/chain.hpp"

namespace tensegric_fit::calibration {

/// One garment at one request on one body, and how its tissue moved.
struct CalibrationCase {
  std::string name;
  tensegric::Garment garment;
  ReferenceField reference;
  std::vector<double> newtons;  ///< the reference's tension in each line; empty: not known
};

/// How fine a model is: what the tissue's constants must not depend on.
struct Fineness {
  int control_triangles, layers;
};

/// A body and its cases; those of one garment in the order of growing requests.
struct CalibrationBody {
  std::string name;
  fit::Body body;
  std::vector<CalibrationCase> cases;
  std::optional<Fineness> fineness{};  ///< none: that of the settings
};

/// How a case went.
struct CaseOutcome {
  double error;  ///< root mean square distance to the reference, m
  tensegric::Status status;
  int iterations;
  double milliseconds;           ///< of the solution
  std::vector<double> tensions;  ///< N, one per line
  std::vector<Eigen::Vector3d> deformed;
};

/// Root mean square way of the reference, m: the error of not moving.
double not_moving(const ReferenceField& reference);

/// All cases of a body, each from rest or, where `warm`, from the one before under the same garment. Of
/// `patterns` those count that bear the names of a garment's regions. \throw Refusal as prepare and wear
std::vector<CaseOutcome> wear_cases(const CalibrationBody& body,
                                    const std::vector<control_mesh::Template>& patterns,
                                    const fit::Settings& settings, bool warm);

/// What is fitted, of those in tissue_yaml that are numbers.
struct CalibrationOptions {
  std::vector<std::string> fitted = {"strut_stiffness", "lateral_stiffness", "skin", "volume_stiffness"};
  int most_iterations = 20;
};

/// Errors of one case: root mean square distance to the reference, m.
struct CalibrationError {
  std::string name;
  double not_moving, before, in_sample, out_of_sample;
};

struct Calibration {
  fit::Settings settings;  ///< those of the start, with what was fitted on all bodies
  std::vector<CalibrationError> errors;
  std::vector<fit::Settings> left_out;  ///< one per body: fitted on the others
};

/// Relative errors of all cases count alike. Each body is left out once. `patterns` as for wear_cases. \throw
/// Refusal bad_option: a name that cannot be fitted; too_few_data: fewer than three bodies; at_bound naming
/// what ran into its bounds; not_settled: no fit of a body
Calibration calibrate(const std::vector<CalibrationBody>& bodies,
                      const std::vector<control_mesh::Template>& patterns, const fit::Settings& start,
                      const CalibrationOptions& options, const std::function<void(const std::string&)>& say);

}  // namespace tensegric_fit::calibration
