/// scan/points -> body/mesh
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/PointCloud2.h>

#include "geometry/point_cloud.hpp"
#include "inspect/markers.hpp"
#include "reconstruction/reconstruct.hpp"
#include "ros/body_messages.hpp"
#include "ros/display.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::node {
namespace {

reconstruction::Options options_from(Parameters& parameters) {
  reconstruction::Options options;
  options.body_triangles = parameters.integer("body_triangles", options.body_triangles, 1000, 2000000);
  options.poisson_depth = parameters.integer("poisson_depth", options.poisson_depth, 5, 10);
  options.min_points = parameters.integer("min_points", options.min_points, 100, 10000000);
  options.max_points = parameters.integer("max_points", options.max_points, 100, 100000000);
  options.support_distance = parameters.number("support_distance", options.support_distance, 0.001, 0.1);
  parameters.check_all_known();
  return options;
}

class ReconstructionNode {
 public:
  ReconstructionNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : display_(private_node), stage_("reconstruction", node) {
    Parameters parameters(private_node);
    options_ = options_from(parameters);
    mesh_ = node.advertise<TriangleMesh>("body/mesh", 1, true);
    scan_ = node.subscribe("scan/points", 2, &ReconstructionNode::on_scan, this);
  }

 private:
  void on_scan(const sensor_msgs::PointCloud2::ConstPtr& scan) {
    const ScanTag tag = tag_of(*scan);
    stage_.begin(tag.scan_id);
    stage_.post(tag.scan_id, [this, scan, tag] { return reconstruct(*scan, tag); });
  }

  Stage::Result reconstruct(const sensor_msgs::PointCloud2& scan, const ScanTag& tag) {
    pcl::PCLPointCloud2 cloud;
    pcl_conversions::toPCL(scan, cloud);
    const auto body = std::make_shared<const reconstruction::BodyMesh>(
        reconstruction::reconstruct(geometry::points_of(cloud), options_));
    const TriangleMesh message = to_message(tag, body->mesh, body->filled);
    return {[this, message, body, tag] {
              mesh_.publish(message);
              show(body, tag.header);
            },
            {{"points_used", std::to_string(body->points_used)},
             {"vertices", std::to_string(body->mesh.vertices.size())},
             {"triangles", std::to_string(body->mesh.triangles.size())},
             {"holes_closed", std::to_string(body->holes.size())}}};
  }

  void show(const std::shared_ptr<const reconstruction::BodyMesh>& body, const std_msgs::Header& header) {
    const auto colours = [body] { return skin_colours(body->mesh, {}, facing(body->mesh)); };
    display_.markers.offer([=] { return inspect::Markers(header).body(body->mesh, colours()).share(); });
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(header, body->mesh, {}); });
    display_.image.offer([=] { return front_image(header, body->mesh, {}, {}, facing(body->mesh)); });
  }

  reconstruction::Options options_;
  ros::Publisher mesh_;
  Display display_;
  ros::Subscriber scan_;
  Stage stage_;
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ReconstructionNode>(argc, argv, "reconstruction");
}
