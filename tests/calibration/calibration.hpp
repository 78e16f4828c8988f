/// Fits the tissue's parameters to reference displacements, or to second scans with the garment on (P2 §6:
/// the model's parameters can be adjusted where it is correlated with a real object).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/reference_field.hpp"
#include "calibration/worn_reference.hpp"
#include "fit/chain.hpp"

namespace tensegric_fit::calibration {

/// One garment at one request on one body, and how its tissue moved.
struct CalibrationCase {
  std::string name;
  tensegric::Garment garment;
  ReferenceField reference;     ///< empty where `worn` is the reference
  std::vector<double> newtons;  ///< the reference's tension in each line; empty: not known
  std::optional<WornReference> worn{};
  double still = 0;  ///< the error of not moving, m
};

/// What can be fitted.
struct Adjusted {
  fit::Settings settings;
  double pull = 1;  ///< by how much more than it says a garment shortens its lines: 1 - ratio times this
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

inline constexpr double kLeastPull = 1e-6;  ///< N: a slack line's, for its logarithm

/// How a case went.
struct CaseOutcome {
  double error;  ///< root mean square distance to the reference, m: of points, or of a worn scan's skin
  tensegric::Status status;
  int iterations;
  double milliseconds;           ///< of the solution
  std::vector<double> tensions;  ///< N, one per line
  std::vector<Eigen::Vector3d> deformed;
};

/// A case by each kind of reference, with its `still`.
CalibrationCase displaced_case(std::string name, tensegric::Garment garment, ReferenceField reference,
                               std::vector<double> newtons);
CalibrationCase worn_case(std::string name, tensegric::Garment garment, WornReference worn,
                          const fit::Body& bare);

/// All cases of a body, each from rest or, where `warm`, from the one before under the same garment. Of
/// `patterns` those count that bear the names of a garment's regions. \throw Refusal as prepare and wear
std::vector<CaseOutcome> wear_cases(const CalibrationBody& body,
                                    const std::vector<control_mesh::Template>& patterns,
                                    const Adjusted& adjusted, bool warm);

/// What of `settings` says what tissue is like, as fit::take_tissue reads it: constants hold for the reach
/// (`beta`) that they were fitted with.
std::string tissue_yaml(const fit::Settings& settings);

/// What is fitted: of those in tissue_yaml that are numbers, and `pull`.
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
  Adjusted adjusted;  ///< the start, with what was fitted on all bodies
  std::vector<CalibrationError> errors;
  std::vector<Adjusted> left_out;  ///< one per body: fitted on the others
};

/// Relative errors of all cases count alike. Each body is left out once. `patterns` as for wear_cases. \throw
/// Refusal bad_option: a name that cannot be fitted; too_few_data: fewer than three bodies by their names,
/// however many meshes; at_bound naming what ran into its bounds; not_settled: no fit of a body
Calibration calibrate(const std::vector<CalibrationBody>& bodies,
                      const std::vector<control_mesh::Template>& patterns, const Adjusted& start,
                      const CalibrationOptions& options, const std::function<void(const std::string&)>& say);

/// Which has the least mean error of cases left out, relative to not moving. One with a case that did not
/// settle has none. \throw Refusal not_settled: none has one
std::size_t least_left_out(const std::vector<Calibration>& found);

}  // namespace tensegric_fit::calibration
