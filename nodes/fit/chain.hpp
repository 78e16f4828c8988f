/// The whole chain in one process: the same core calls as the nodes make, in the same order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "body_model/registration.hpp"
#include "control_mesh/fit_template.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/fibre.hpp"
#include "geometry/fit_warning.hpp"
#include "geometry/point_cloud.hpp"
#include "landmarks/find_landmarks.hpp"
#include "reconstruction/reconstruct.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/model.hpp"
#include "tensegric/solver.hpp"
#include "tffd/binding.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::fit {

/// Options of all stages.
struct Settings {
  reconstruction::Options reconstruction;
  control_mesh::Options control_mesh;
  tensegric::ModelOptions model;
  tensegric::SolverOptions solver;
  tffd::Options tffd;
  tffd::HoldOptions hold;
};

/// What a stage took, milliseconds of wall clock.
struct StageTimes {
  double reconstruction = 0, body_model = 0, landmarks = 0, control_mesh = 0, tensegric = 0, tffd = 0;
};

/// A body as far as it is known without a garment.
struct Body {
  reconstruction::BodyMesh mesh;
  std::optional<body_model::RegisteredBody> model;  ///< none of a shape that was not measured
  geometry::BodyMeasures measures;
};

/// A body made ready for a region: everything that a change of garment does not touch.
struct Fitting {
  geometry::ControlMesh control;
  tensegric::Model model;
  tffd::Binding binding;                              ///< in the posture of the settings
  std::vector<std::vector<Eigen::Vector3i>> carried;  ///< body triangles, one list a region
  std::vector<tensegric::PosedVolume> body_volumes;   ///< one per region where the body's volume is kept
};

/// A garment worn.
struct Fit {
  tensegric::Solution solution;
  std::vector<Eigen::Vector3d> deformed;    ///< one per body vertex, scan frame
  geometry::BoneFrames bones;               ///< the posture in which it is worn
  std::vector<double> distortion;           ///< area after / before, one per body vertex (P1 Fig. 8)
  std::vector<double> body_volumes_before;  ///< one per region, m^3, under the skin that it carries
  std::vector<double> body_volumes_after;
};

/// 1 and 2: scan -> mesh -> landmarks and girths.
Body measure_scan(const geometry::PointCloud& scan, const Settings& settings, StageTimes& times);

/// A mesh taken as it is, nothing measured. \throw Refusal bad_mesh, non_finite
Body take_mesh(geometry::TriangleMesh mesh);

/// The same, measured.
Body measure_mesh(geometry::TriangleMesh mesh, const Settings& settings, StageTimes& times);

/// 3: landmarks -> control mesh -> model, and the binding of the body's vertices. One piece of control mesh a
/// template.
Fitting prepare(const Body& body, const std::vector<control_mesh::Template>& patterns,
                const Settings& settings, StageTimes& times);

/// The same for a control mesh that is given (P1 §3.2).
Fitting prepare(const Body& body, geometry::ControlMesh control, const Settings& settings, StageTimes& times);

/// The garment's lines that lie on the body, laid on its skin.
std::vector<geometry::LaidLine> laid_lines(const Body& body, const Fitting& fitting,
                                           const tensegric::Garment& garment);

/// 4 and 5: tensegric deformation -> t-FFD of the body -> distortion. `settings` as for the fitting; `start`:
/// an earlier fit on it, or null.
Fit wear(const Body& body, const Fitting& fitting, const tensegric::Garment& garment,
         const Settings& settings, StageTimes& times, const tensegric::Solution* start = nullptr);

/// Warnings and notices (tffd/skin_check.hpp, tffd/under_constriction.hpp): turns in the posture's frame,
/// lines over the skin as it was scanned.
std::vector<geometry::FitWarning> warnings_of(const Body& body, const Fitting& fitting, const Fit& fit,
                                              const Settings& settings);

}  // namespace tensegric_fit::fit
