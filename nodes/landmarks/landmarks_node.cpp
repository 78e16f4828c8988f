/// body/mesh -> body/landmarks
#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include "inspect/markers.hpp"
#include "landmarks/find_landmarks.hpp"
#include "ros/body_messages.hpp"
#include "ros/display.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::node {
namespace {

/// What there is to show of the landmarks of a scan.
struct MeasuredBody {
  std_msgs::Header header;
  geometry::TriangleMesh mesh;
  geometry::BodyMeasures measures;
};

class LandmarksNode {
 public:
  LandmarksNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : display_(private_node), stage_("landmarks", node) {
    Parameters parameters(private_node);
    body_frame_ = parameters.text("body_frame", "body");
    parameters.check_all_known();
    landmarks_ = node.advertise<Landmarks>("body/landmarks", 1, true);
    transform_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
    mesh_ = node.subscribe("body/mesh", 2, &LandmarksNode::on_mesh, this, ros::TransportHints().tcpNoDelay());
  }

 private:
  void on_mesh(const TriangleMesh::ConstPtr& mesh) {
    stage_.begin(mesh->scan_id);
    stage_.post(mesh->scan_id, [this, mesh] { return find(*mesh); });
  }

  Stage::Result find(const TriangleMesh& mesh) {
    auto body = std::make_shared<MeasuredBody>();
    body->header = mesh.header;
    body->mesh = mesh_in(mesh);
    body->measures = landmarks::find_landmarks(body->mesh, filled_in(mesh), options_);
    const Landmarks message = to_message(tag_in(mesh), body->measures);
    return {[this, message, body] {
              publish_body_frame(body->header, body->measures.body_from_scan);
              landmarks_.publish(message);
              show(body);
            },
            {{"landmarks", std::to_string(body->measures.landmarks.size())}}};
  }

  /// tf: where the body's frame lies in the scan's, for rviz and for whoever works in body coordinates.
  void publish_body_frame(const std_msgs::Header& header, const Eigen::Isometry3d& body_from_scan) {
    if (header.frame_id == body_frame_) {  // tf knows no frame within itself
      ROS_WARN_ONCE("landmarks: the scan's frame is called '%s', too: ~body_frame needs another name for tf",
                    body_frame_.c_str());
      return;
    }
    tf2_msgs::TFMessage message;
    message.transforms.emplace_back();
    message.transforms.back().header = header;
    message.transforms.back().child_frame_id = body_frame_;
    const Eigen::Isometry3d scan_from_body = body_from_scan.inverse();
    const Eigen::Quaterniond turn(scan_from_body.rotation());
    geometry_msgs::Transform& transform = message.transforms.back().transform;
    transform.translation.x = scan_from_body.translation().x();
    transform.translation.y = scan_from_body.translation().y();
    transform.translation.z = scan_from_body.translation().z();
    transform.rotation.x = turn.x();
    transform.rotation.y = turn.y();
    transform.rotation.z = turn.z();
    transform.rotation.w = turn.w();
    transform_.publish(message);
  }

  void show(const std::shared_ptr<const MeasuredBody>& body) {
    display_.markers.offer([=] { return inspect::Markers(body->header).landmarks(body->measures).share(); });
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(body->header, body->mesh, {}); });
    display_.image.offer([=] {
      std::vector<inspect::Polyline> tapes;
      for (const geometry::GirthLoop& loop : body->measures.loops)
        tapes.push_back({loop.points, true, {40, 110, 220}});
      return front_image(body->header, body->mesh, {}, tapes, body->measures.body_from_scan);
    });
  }

  const landmarks::Options options_{};
  std::string body_frame_;
  ros::Publisher landmarks_, transform_;
  Display display_;
  ros::Subscriber mesh_;
  Stage stage_;
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::LandmarksNode>(argc, argv, "landmarks");
}
