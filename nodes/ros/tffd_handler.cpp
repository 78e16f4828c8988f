#include "ros/tffd_handler.hpp"

#include <boost/make_shared.hpp>

#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "tffd/distortion.hpp"

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
  if (posture.twist != 0 || posture.side_lean != 0)
    binding = binding.posed(geometry::BoneFrames(measures, posture));
  return std::make_shared<const BoundBody>(BoundBody{scan.body, scan.control, std::move(mesh),
                                                     std::move(control), measures.body_from_scan, posture,
                                                     std::move(binding), volume});
}

}  // namespace

TffdHandler::TffdHandler(Parameters parameters) {
  const std::string setting = parameters.choice("setting", "standard", {"standard", "paper"});
  options_.setting = setting == "paper" ? tffd::Setting::paper : tffd::Setting::standard;
  options_.beta = parameters.number("beta", options_.beta, 0, 20);
  options_.precision = parameters.choice("precision", "reference", {"reference", "fast"}) == "fast"
                           ? tffd::Precision::fast
                           : tffd::Precision::reference;
  options_.truncation = parameters.number("truncation", options_.truncation, 0, 0.1);
  parameters.check_all_known();
}

TffdHandler::Output TffdHandler::handle(const Input& input) {
  const auto& [fit, body, landmarks, control] = input;
  FittedScan scan{body, landmarks, control, fit, nullptr};
  if (!bound_ || !is_of(*bound_, scan)) bound_ = bind(scan, options_);
  const std::vector<Eigen::Vector3d> outer = points_in(fit->outer);
  const std::vector<Eigen::Vector3d> vertices = bound_->binding.deform(outer, points_in(fit->inner));
  const std::vector<double> distortion =
      tffd::body_distortion(bound_->binding, tffd::control_distortion(bound_->control_mesh, outer));

  const auto message = boost::make_shared<DeformedMesh>();
  message->header = fit->header;
  message->scan_id = fit->scan_id;
  message->garment = fit->garment;
  message->status = fit->status;
  message->vertices = flat<float>(vertices);
  message->distortion.assign(distortion.begin(), distortion.end());
  message->volume_before = bound_->volume;
  message->volume_after = geometry::cone_volume(vertices, bound_->mesh.triangles);
  scan.deformed = message;
  return {scan, bound_, {{"garment", fit->garment}}};
}

}  // namespace tensegric_fit::node
