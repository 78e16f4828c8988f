/// body/mesh + body/landmarks -> control/mesh
#include "control_mesh/fit_template.hpp"
#include "geometry/shipped_files.hpp"
#include "inspect/markers.hpp"
#include "ros/body_messages.hpp"
#include "ros/display.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_join.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::node {
namespace {

/// What there is to show of a control mesh.
struct CoveredBody {
  std_msgs::Header header;
  geometry::TriangleMesh mesh;
  geometry::ControlMesh control;
  Eigen::Isometry3d body_from_scan;
};

class ControlMeshNode {
 public:
  ControlMeshNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : display_(private_node), stage_("control_mesh", node) {
    Parameters parameters(private_node);
    options_.control_triangles =
        parameters.integer("control_triangles", options_.control_triangles, 1, 100000);
    const std::string name = parameters.text("template", "bust");
    const std::string folder = parameters.text("template_directory", geometry::shipped_folder("templates"));
    parameters.check_all_known();
    pattern_ =
        control_mesh::load_template(geometry::yaml_file(folder, name, geometry::refusal::kBadTemplate));

    control_ = node.advertise<ControlMesh>("control/mesh", 1, true);
    const ros::TransportHints prompt = ros::TransportHints().tcpNoDelay();
    mesh_ = node.subscribe("body/mesh", 2, &ControlMeshNode::on_mesh, this, prompt);
    landmarks_ = node.subscribe("body/landmarks", 2, &ControlMeshNode::on_landmarks, this, prompt);
  }

 private:
  void on_mesh(const TriangleMesh::ConstPtr& mesh) {
    stage_.begin(mesh->scan_id);
    join_.add(mesh);
  }

  void on_landmarks(const Landmarks::ConstPtr& landmarks) { join_.add(landmarks); }

  Stage::Result fit(const Landmarks& landmarks, const TriangleMesh& mesh) {
    auto body = std::make_shared<CoveredBody>();
    body->header = mesh.header;
    body->mesh = mesh_in(mesh);
    const geometry::BodyMeasures measures = measures_in(landmarks);
    body->body_from_scan = measures.body_from_scan;
    body->control = control_mesh::fit_template(pattern_, body->mesh, measures, options_);
    const ControlMesh message = to_message(tag_in(mesh), body->control);
    return {[this, message, body] {
              control_.publish(message);
              show(body);
            },
            {{"nodes", std::to_string(body->control.outer.size())},
             {"triangles", std::to_string(body->control.triangles.size())}}};
  }

  void show(const std::shared_ptr<const CoveredBody>& body) {
    const auto& control = body->control;
    display_.markers.offer([=] {
      return inspect::Markers(body->header).control_mesh(body->control, body->control.outer).share();
    });
    display_.polygon_mesh.offer([=] {
      return inspect::polygon_mesh(body->header, {control.outer, control.triangles}, {});
    });
    display_.image.offer([=] {
      std::vector<inspect::Polyline> edges;
      for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles}))
        edges.push_back({{control.outer[edge.first], control.outer[edge.second]}, false, {60, 60, 60}});
      return front_image(body->header, body->mesh, {}, edges, body->body_from_scan);
    });
  }

  control_mesh::Options options_;
  control_mesh::Template pattern_;
  ros::Publisher control_;
  Display display_;
  ros::Subscriber mesh_, landmarks_;
  ScanJoin<Landmarks, TriangleMesh> join_{[this](const auto& landmarks, const auto& mesh) {
    stage_.post(mesh->scan_id, [this, landmarks, mesh] { return fit(*landmarks, *mesh); });
  }};
  Stage stage_;
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::ControlMeshNode>(argc, argv, "control_mesh");
}
