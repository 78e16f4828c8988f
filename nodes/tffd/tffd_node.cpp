/// body/mesh + body/landmarks + control/mesh + control/deformed -> body/deformed, body/warnings
#include "ros/display.hpp"
#include "ros/export_desk.hpp"
#include "ros/flat.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"
#include "tffd/tffd_handler.hpp"

namespace tensegric_fit::node {
namespace {

class TffdNode {
 public:
  TffdNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(Parameters(private_node)),
        deformed_(node.advertise<DeformedMesh>("body/deformed", 1, true)),
        passing_(node.advertise<DeformedMesh>("body/deformed", 1)),
        warnings_(node.advertise<FitWarnings>("body/warnings", 1, true)),
        display_(private_node),
        exports_(node, handler_.exports()),
        inputs_(node, [this](const std::string& scan_id,
                             const geometry::Refusal& why) { stage_.refuse(scan_id, why); }),
        stage_("tffd", node) {
    inputs_.subscribe_from("reconstruction", "body/mesh", 2, &TffdNode::on_body, this, kPrompt);
    inputs_.subscribe_from("landmarks", "body/landmarks", 2, &TffdNode::on<Landmarks>, this, kPrompt);
    inputs_.subscribe_from("control_mesh", "control/mesh", 2, &TffdNode::on<ControlMesh>, this, kPrompt);
    inputs_.subscribe_from("tensegric", "control/deformed", 8, &TffdNode::on<FitState>, this, kPrompt);
    inputs_.subscribe("control/forces", 4, &TffdNode::on_forces, this, kPrompt);
    inputs_.subscribe("scan/label", 16, &TffdNode::on_label, this);
  }

 private:
  using Output = TffdHandler::Output;
  inline static const ros::TransportHints kPrompt = ros::TransportHints().tcpNoDelay();

  void on_body(const TriangleMesh::ConstPtr& body) {
    stage_.begin(body->scan_id);
    on(body);
  }

  void on_forces(const LineForces::ConstPtr& forces) { exports_.keep(forces); }
  void on_label(const ScanLabel::ConstPtr& label) { exports_.keep(*label); }

  template <typename Message>
  void on(const boost::shared_ptr<const Message>& message) {
    const auto input = handler_.add(message);
    if (!input) return;
    const auto work = [this, input = *input]() -> Stage::Result {
      const Output output = handler_.handle(input);
      return {[this, output] { publish(output); }, output.facts, said(output)};
    };
    if (std::get<FitState::ConstPtr>(*input)->status == FitState::SOLVING)
      stage_.post_passing(message->scan_id, work);
    else
      stage_.post(message->scan_id, work);
  }

  // Its warnings, for people.
  static std::string said(const Output& output) {
    std::string words;
    if (output.warnings)
      for (const FitWarning& warning : output.warnings->warnings)
        words += (words.empty() ? "" : " ") + warning.message;
    return words;
  }

  void publish(const Output& output) {
    if (output.scan.fit->status == FitState::SOLVING) return passing_.publish(output.scan.deformed);
    exports_.keep(output.scan);  // first: who hears of the fit may ask for its export
    deformed_.publish(output.scan.deformed);
    warnings_.publish(output.warnings);
    show(output.scan.deformed, output.bound);
  }

  void show(const DeformedMesh::ConstPtr& deformed, const std::shared_ptr<const BoundBody>& bound) {
    const auto shape = [=] {
      return geometry::TriangleMesh{points_in(deformed->vertices), bound->mesh.triangles};
    };
    const auto distortion = [=] {
      return std::vector<double>(deformed->distortion.begin(), deformed->distortion.end());
    };
    const std_msgs::Header header = deformed->header;
    display_.markers.offer([=] {
      const geometry::TriangleMesh mesh = shape();
      return inspect::Markers(header)
          .body(mesh, skin_colours(mesh, distortion(), bound->measures.body_from_scan))
          .share();
    });
    display_.polygon_mesh.offer(
        [=] { return inspect::polygon_mesh(header, shape(), inspect::distortion_colours(distortion())); });
    display_.image.offer(
        [=] { return front_image(header, shape(), distortion(), {}, bound->measures.body_from_scan); });
  }

  TffdHandler handler_;
  ros::Publisher deformed_, passing_;  // one topic: how a fit ended is kept for late joiners
  ros::Publisher warnings_;
  Display display_;
  ExportDesk exports_;
  WatchedInputs inputs_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::TffdNode>(argc, argv, "tffd");
}
