/// body/mesh + body/landmarks + body/model -> control/mesh, control/coarse
#include "control_mesh/control_mesh_handler.hpp"
#include "ros/display.hpp"
#include "ros/log_words.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"

namespace tensegric_fit::node {
namespace {

class ControlMeshNode {
 public:
  ControlMeshNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(Parameters(private_node)),
        control_(node.advertise<ControlMesh>("control/mesh", 1, true)),
        coarse_(node.advertise<ControlMesh>("control/coarse", 1, true)),
        display_(private_node),
        inputs_(node, [this](const std::string& scan_id,
                             const geometry::Refusal& why) { stage_.refuse(scan_id, why); }),
        stage_("control_mesh", node) {
    const ros::TransportHints prompt = ros::TransportHints().tcpNoDelay();
    inputs_.subscribe_from("reconstruction", "body/model", 2, &ControlMeshNode::on_model, this, prompt);
    inputs_.subscribe_from("reconstruction", "body/mesh", 2, &ControlMeshNode::on_mesh, this, prompt);
    inputs_.subscribe_from("landmarks", "body/landmarks", 2, &ControlMeshNode::on_landmarks, this, prompt);
  }

 private:
  using Output = ControlMeshHandler::Output;

  void on_model(const BodyModel::ConstPtr& model) { handler_.add(model); }

  void on_mesh(const TriangleMesh::ConstPtr& mesh) {
    stage_.begin(mesh->scan_id);
    fit(mesh->scan_id, handler_.add(mesh));
  }

  void on_landmarks(const Landmarks::ConstPtr& landmarks) {
    fit(landmarks->scan_id, handler_.add(landmarks));
  }

  void fit(const std::string& scan_id, const std::optional<ControlMeshHandler::Input>& input) {
    if (!input) return;
    stage_.post(scan_id, [this, input = *input]() -> Stage::Result {
      const auto output = std::make_shared<const Output>(handler_.handle(input));
      if (!output->left_out.empty()) ROS_WARN("a region of the template was left out");
      return {[this, output] {
                if (output->coarse) coarse_.publish(output->coarse);  // first: it is not waited for
                control_.publish(output->control);
                show(output);
              },
              output->facts};
    });
  }

  void show(const std::shared_ptr<const Output>& output) {
    const std_msgs::Header header = output->control->header;
    const auto& control = output->control_mesh;
    display_.markers.offer(
        [=] { return inspect::Markers(header).control_mesh(control, control.outer).share(); });
    display_.polygon_mesh.offer([=] {
      return inspect::polygon_mesh(header, {control.outer, control.triangles}, {});
    });
    display_.image.offer([=] {
      std::vector<inspect::Polyline> edges;
      for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles}))
        edges.push_back({{control.outer[edge.first], control.outer[edge.second]}, false, {60, 60, 60}});
      return front_image(header, output->body, {}, edges, output->body_from_scan);
    });
  }

  ControlMeshHandler handler_;
  ros::Publisher control_, coarse_;
  Display display_;
  WatchedInputs inputs_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ControlMeshNode>(argc, argv, "control_mesh");
}
