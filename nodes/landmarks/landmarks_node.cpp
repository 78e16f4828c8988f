/// body/mesh + body/model -> body/landmarks
#include "landmarks/landmarks_handler.hpp"
#include "ros/display.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"

namespace tensegric_fit::node {
namespace {

class LandmarksNode {
 public:
  LandmarksNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(Parameters(private_node)),
        landmarks_(node.advertise<Landmarks>("body/landmarks", 1, true)),
        body_frame_(node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true)),
        display_(private_node),
        inputs_(node, [this](const std::string& scan_id,
                             const geometry::Refusal& why) { stage_.refuse(scan_id, why); }),
        stage_("landmarks", node) {
    const ros::TransportHints prompt = ros::TransportHints().tcpNoDelay();
    constexpr bool kOnce = true, kStarted = false;
    patience_ = node.createWallTimer(
        ros::WallDuration(LandmarksHandler::kPatience),
        [this](const ros::WallTimerEvent&) { find(handler_.alone()); }, kOnce, kStarted);
    inputs_.subscribe_from("reconstruction", "body/model", 2, &LandmarksNode::on_model, this, prompt);
    inputs_.subscribe_from("reconstruction", "body/mesh", 2, &LandmarksNode::on_mesh, this, prompt);
  }

 private:
  using Output = LandmarksHandler::Output;

  void on_mesh(const TriangleMesh::ConstPtr& mesh) {
    stage_.begin(mesh->scan_id);
    patience_.stop();
    patience_.start();  // in vain where the model is there
    find(handler_.add(mesh));
  }

  void on_model(const BodyModel::ConstPtr& model) { find(handler_.add(model)); }

  void find(const std::optional<LandmarksHandler::Input>& input) {
    if (!input) return;
    stage_.post(std::get<0>(*input)->scan_id, [this, input = *input]() -> Stage::Result {
      const auto output = std::make_shared<const Output>(handler_.handle(input));
      return {[this, output] { publish(output); }, output->facts, output->warning};
    });
  }

  void publish(const std::shared_ptr<const Output>& output) {
    if (output->body_frame)
      body_frame_.publish(output->body_frame);
    else
      ROS_WARN_ONCE("landmarks: the scan's frame is called '%s', too: ~body_frame needs another name for tf",
                    handler_.body_frame().c_str());
    landmarks_.publish(output->landmarks);

    const std_msgs::Header header = output->landmarks->header;
    display_.markers.offer([=] { return inspect::Markers(header).landmarks(output->measures).share(); });
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(header, output->mesh, {}); });
    display_.image.offer([=] {
      std::vector<inspect::Polyline> tapes;
      for (const geometry::GirthLoop& loop : output->measures.loops)
        tapes.push_back({loop.points, true, {40, 110, 220}});
      return front_image(header, output->mesh, {}, tapes, output->measures.body_from_scan);
    });
  }

  LandmarksHandler handler_;
  ros::Publisher landmarks_, body_frame_;
  Display display_;
  ros::WallTimer patience_;
  WatchedInputs inputs_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::LandmarksNode>(argc, argv, "landmarks");
}
