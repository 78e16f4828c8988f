/// scan/points -> body/model, body/mesh
#include <tf2_ros/transform_listener.h>

#include "reconstruction/reconstruction_handler.hpp"
#include "ros/display.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"

namespace tensegric_fit::node {
namespace {

class ReconstructionNode {
 public:
  ReconstructionNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(Parameters(private_node)),
        body_frame_(Parameters(ros::NodeHandle(node, "landmarks")).frame("body_frame", "body")),
        model_(node.advertise<BodyModel>("body/model", 1, true)),
        mesh_(node.advertise<TriangleMesh>("body/mesh", 1, true)),
        display_(private_node),
        inputs_(node),
        stage_("reconstruction", node) {
    inputs_.subscribe("scan/points", 2, &ReconstructionNode::on_scan, this);
  }

 private:
  void on_scan(const sensor_msgs::PointCloud2::ConstPtr& scan) {
    const ScanTag tag = tag_of(*scan);
    stage_.begin(tag.scan_id);
    stage_.post(tag.scan_id, [this, scan, tag]() -> Stage::Result {
      const auto output = handler_.handle(*scan, tag);
      const std::string lacks = lacks_of(scan->header,
                                         frames_of_others(transforms_.allFramesAsYAML(), body_frame_)),
                        company = company_of(output.result->model);
      return {[this, output] {
                model_.publish(output.model);
                mesh_.publish(output.mesh);
                show(output.result, output.mesh->header);
              },
              output.facts,
              lacks.empty()     ? company
              : company.empty() ? lacks
                                : lacks + " " + company};
    });
  }

  void show(const std::shared_ptr<const reconstruction::Reconstruction>& result,
            const std_msgs::Header& header) {
    const std::shared_ptr<const geometry::TriangleMesh> body(result, &result->body.mesh);
    const auto colours = [body] { return skin_colours(*body, {}, facing(*body)); };
    display_.markers.offer([=] {
      const body_model::RegisteredBody& model = result->model;
      const inspect::ModelSkin skin{model.skin, model.model->quads, model.model->part, model.model->parts};
      return inspect::Markers(header).body(*body, colours()).model(skin).share();
    });
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(header, *body, {}); });
    display_.image.offer([=] { return front_image(header, *body, {}, {}, facing(*body)); });
  }

  const ReconstructionHandler handler_;
  const std::string body_frame_;  // that of landmarks
  ros::Publisher model_, mesh_;
  Display display_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_{transforms_};
  WatchedInputs inputs_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ReconstructionNode>(argc, argv, "reconstruction");
}
