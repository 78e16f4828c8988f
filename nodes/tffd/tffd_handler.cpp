#include "tffd/tffd_handler.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>

#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "ros/warning_messages.hpp"
#include "tffd/distortion.hpp"
#include "tffd/garment_check.hpp"

namespace tensegric_fit::node {
namespace {

geometry::Posture posture_of(const FitState& fit) {
  return {fit.twist, fit.side_lean};
}

bool is_of(const BoundBody& bound, const FittedScan& scan) {
  const geometry::Posture posture = posture_of(*scan.fit);
  return bound.body == scan.body && bound.control == scan.control && bound.posture.twist == posture.twist &&
         bound.posture.side_lean == posture.side_lean;
}

std::shared_ptr<const BoundBody> bind(const FittedScan& scan, const tffd::Options& options) {
  geometry::TriangleMesh mesh = mesh_in(*scan.body);
  geometry::ControlMesh control = control_in(*scan.control);
  tffd::Binding binding(mesh, control, options);
  const double volume = geometry::cone_volume(mesh.vertices, mesh.triangles);
  const geometry::BodyMeasures measures = measures_in(*scan.landmarks);
  const geometry::Posture posture = posture_of(*scan.fit);
  const geometry::BoneFrames bones = bones_of(*scan.fit, measures);
  if (!bones.still()) binding = binding.posed(bones);
  return std::make_shared<const BoundBody>(BoundBody{scan.body, scan.control, std::move(mesh),
                                                     std::move(control), measures, posture,
                                                     std::move(binding), volume});
}

// What there is to warn of; turns in the posture's frame, lines over the skin as it was scanned.
std::vector<geometry::FitWarning> warnings_of(const FitState& fit, const BoundBody& bound,
                                              const std::vector<Eigen::Vector3d>& worn,
                                              const tffd::HoldOptions& hold) {
  std::vector<tffd::WornLine> lines;
  for (const LineResult& line : fit.lines)
    lines.push_back({line.name, points_in(line.course_at_rest), points_in(line.course), line.neutral,
                     line.final, line.tension});
  return tffd::check_garment({bound.mesh.vertices, filled_in(*bound.body)},
                             {bound.binding.vertices(), worn, bound.mesh.triangles}, lines, hold);
}

std::string codes_of(const std::vector<FitWarning>& warnings) {
  std::string codes;
  for (const FitWarning& warning : warnings) codes += (codes.empty() ? "" : ", ") + warning.code;
  return codes;
}

}  // namespace

TffdHandler::TffdHandler(Parameters parameters) {
  const std::string setting = parameters.choice("setting", "standard", {"standard", "paper"});
  options_.setting = setting == "paper" ? tffd::Setting::paper : tffd::Setting::standard;
  options_.beta = parameters.number("beta", options_.beta, geometry::kBetaOrNone);
  options_.precision = parameters.choice("precision", "reference", {"reference", "fast"}) == "fast"
                           ? tffd::Precision::fast
                           : tffd::Precision::reference;
  options_.truncation = parameters.number("truncation", options_.truncation, tffd::kTruncation);
  hold_.least_pull = parameters.number("least_pull", hold_.least_pull, tffd::kLeastPull);
  exports_ = export_options(parameters);
  parameters.check_all_known();
  tffd::check_options(options_);
}

TffdHandler::Output TffdHandler::handle(const Input& input) {
  const auto& [fit, body, landmarks, control] = input;
  check_lines(*fit);
  FittedScan scan{body, landmarks, control, fit, nullptr, {}};
  if (!bound_ || !is_of(*bound_, scan)) bound_ = bind(scan, options_);
  const std::vector<Eigen::Vector3d> outer = points_in(fit->outer);
  const std::vector<Eigen::Vector3d> vertices = bound_->binding.deform(outer, points_in(fit->inner));
  const std::vector<double> distortion =
      tffd::body_distortion(bound_->binding, tffd::control_distortion(bound_->binding, outer));

  const auto message = boost::make_shared<DeformedMesh>();
  message->header = fit->header;
  message->scan_id = fit->scan_id;
  message->garment = fit->garment;
  message->status = fit->status;
  message->vertices = flat<float>(vertices);
  points_in(message->vertices);          // refused as any other's would be, and not by who shows them
  for (const double ratio : distortion)  // of a triangle of hardly any area it may be beyond all floats
    message->distortion.push_back(
        static_cast<float>(std::min<double>(ratio, std::numeric_limits<float>::max())));
  message->volume_before = bound_->volume;
  message->volume_after = geometry::cone_volume(vertices, bound_->mesh.triangles);
  scan.deformed = message;
  if (fit->status == FitState::SOLVING) return {scan, bound_, nullptr, {}};
  scan.warnings = warnings_of(*fit, *bound_, vertices, hold_);
  const auto warnings = boost::make_shared<FitWarnings>(
      to_message(tag_in(*fit), fit->garment, scan.warnings, bound_->measures));
  return {scan,
          bound_,
          warnings,
          {{"garment", fit->garment},
           {"warnings", codes_of(warnings->warnings)},
           {"notices", codes_of(warnings->notices)}}};
}

}  // namespace tensegric_fit::node
