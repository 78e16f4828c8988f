/// body/mesh + body/landmarks + control/mesh + control/deformed -> body/deformed
#include <tensegric_fit/ExportFit.h>

#include <mutex>
#include <optional>

#include "inspect/markers.hpp"
#include "ros/body_messages.hpp"
#include "ros/display.hpp"
#include "ros/export_fit.hpp"
#include "ros/flat.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_join.hpp"
#include "ros/stage.hpp"
#include "tffd/binding.hpp"
#include "tffd/distortion.hpp"

namespace tensegric_fit::node {
namespace {

tffd::Options options_from(const ros::NodeHandle& private_node) {
  tffd::Options options;
  Parameters parameters(private_node);
  const std::string setting = parameters.choice("setting", "standard", {"standard", "paper"});
  options.setting = setting == "paper" ? tffd::Setting::paper : tffd::Setting::standard;
  options.beta = parameters.number("beta", options.beta, 0, 20);
  options.precision = parameters.choice("precision", "reference", {"reference", "fast"}) == "fast"
                          ? tffd::Precision::fast
                          : tffd::Precision::reference;
  options.truncation = parameters.number("truncation", options.truncation, 0, 0.1);
  parameters.check_all_known();
  return options;
}

/// A body bound to its control mesh: what a change of garment does not touch.
struct BoundBody {
  TriangleMesh::ConstPtr body;
  ControlMesh::ConstPtr control;
  geometry::TriangleMesh mesh;
  geometry::ControlMesh control_mesh;
  Eigen::Isometry3d body_from_scan;
  geometry::Posture posture;
  tffd::Binding binding;
  double volume;

  bool is_of(const FittedScan& scan) const {
    return body == scan.body && control == scan.control && posture.twist == scan.fit->twist &&
           posture.side_lean == scan.fit->side_lean;
  }
};

class TffdNode {
 public:
  TffdNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : options_(options_from(private_node)), display_(private_node), stage_("tffd", node) {
    deformed_ = node.advertise<DeformedMesh>("body/deformed", 1, true);
    const ros::TransportHints prompt = ros::TransportHints().tcpNoDelay();
    body_in_ = node.subscribe("body/mesh", 2, &TffdNode::on_body, this, prompt);
    landmarks_in_ = node.subscribe("body/landmarks", 2, &TffdNode::on_landmarks, this, prompt);
    control_in_ = node.subscribe("control/mesh", 2, &TffdNode::on_control, this, prompt);
    fit_in_ = node.subscribe("control/deformed", 8, &TffdNode::on_fit, this, prompt);
    export_ = node.advertiseService("export_fit", &TffdNode::on_export, this);
  }

 private:
  void on_body(const TriangleMesh::ConstPtr& body) {
    stage_.begin(body->scan_id);
    join_.add(body);
  }
  void on_landmarks(const Landmarks::ConstPtr& landmarks) { join_.add(landmarks); }
  void on_control(const ControlMesh::ConstPtr& control) { join_.add(control); }
  void on_fit(const FitState::ConstPtr& fit) {
    if (fit->status != FitState::SOLVING) join_.add(fit);
  }

  Stage::Result deform(FittedScan scan) {
    if (!bound_ || !bound_->is_of(scan)) bound_ = bind(scan);
    const std::vector<Eigen::Vector3d> outer = points_in(scan.fit->outer);
    const std::vector<Eigen::Vector3d> vertices = bound_->binding.deform(outer, points_in(scan.fit->inner));
    const std::vector<double> distortion =
        tffd::body_distortion(bound_->binding, tffd::control_distortion(bound_->control_mesh, outer));

    const auto message = boost::make_shared<DeformedMesh>();
    message->header = scan.fit->header;
    message->scan_id = scan.fit->scan_id;
    message->garment = scan.fit->garment;
    message->status = scan.fit->status;
    message->vertices = flat<float>(vertices);
    message->distortion.assign(distortion.begin(), distortion.end());
    message->volume_before = bound_->volume;
    message->volume_after = geometry::cone_volume(vertices, bound_->mesh.triangles);
    scan.deformed = message;
    return {[this, scan, bound = bound_] {
              deformed_.publish(scan.deformed);
              show(scan, bound);
              std::lock_guard<std::mutex> lock(mutex_);
              fitted_ = scan;
            },
            {{"garment", scan.fit->garment}}};
  }

  std::shared_ptr<const BoundBody> bind(const FittedScan& scan) const {
    geometry::TriangleMesh mesh = mesh_in(*scan.body);
    geometry::ControlMesh control = control_in(*scan.control);
    tffd::Binding binding(mesh, control, options_);
    const double volume = geometry::cone_volume(mesh.vertices, mesh.triangles);
    const geometry::BodyMeasures measures = measures_in(*scan.landmarks);
    const geometry::Posture posture{scan.fit->twist, scan.fit->side_lean};
    if (posture.twist != 0 || posture.side_lean != 0)
      binding = binding.posed(geometry::BoneFrames(measures, posture));
    return std::make_shared<const BoundBody>(BoundBody{scan.body, scan.control, std::move(mesh),
                                                       std::move(control), measures.body_from_scan, posture,
                                                       std::move(binding), volume});
  }

  void show(const FittedScan& scan, const std::shared_ptr<const BoundBody>& bound) {
    const auto shape = [deformed = scan.deformed, bound] {
      return geometry::TriangleMesh{points_in(deformed->vertices), bound->mesh.triangles};
    };
    const auto distortion = [deformed = scan.deformed] {
      return std::vector<double>(deformed->distortion.begin(), deformed->distortion.end());
    };
    const std_msgs::Header header = scan.deformed->header;
    display_.markers.offer([=] {
      const geometry::TriangleMesh mesh = shape();
      return inspect::Markers(header)
          .body(mesh, skin_colours(mesh, distortion(), bound->body_from_scan))
          .share();
    });
    display_.polygon_mesh.offer(
        [=] { return inspect::polygon_mesh(header, shape(), inspect::distortion_colours(distortion())); });
    display_.image.offer(
        [=] { return front_image(header, shape(), distortion(), {}, bound->body_from_scan); });
  }

  bool on_export(ExportFit::Request& request, ExportFit::Response& response) {
    try {
      FittedScan scan;
      {
        std::lock_guard<std::mutex> lock(mutex_);
        scan = fitted_;
      }
      if (!scan.deformed) throw geometry::Refusal(geometry::refusal::kNothingYet, "no fit has ended so far");
      response.files = export_fit(scan, request.directory);
      response.exported = true;
      response.message = "wrote scan " + scan.body->scan_id + ", garment " + scan.fit->garment;
    } catch (const geometry::Refusal& refusal) {
      response.exported = false;
      response.code = refusal.code();
      response.message = refusal.what();
    }
    return true;
  }

  const tffd::Options options_;
  std::shared_ptr<const BoundBody> bound_;  // the worker's
  std::mutex mutex_;
  FittedScan fitted_;
  ros::Publisher deformed_;
  Display display_;
  ros::Subscriber body_in_, landmarks_in_, control_in_, fit_in_;
  ros::ServiceServer export_;
  ScanJoin<FitState, TriangleMesh, Landmarks, ControlMesh> join_{
      [this](const auto& fit, const auto& body, const auto& landmarks, const auto& control) {
        stage_.post(fit->scan_id, [this, scan = FittedScan{body, landmarks, control, fit, nullptr}] {
          return deform(scan);
        });
      }};
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::TffdNode>(argc, argv, "tffd");
}
