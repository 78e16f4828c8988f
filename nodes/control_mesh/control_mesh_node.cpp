/// body/mesh + body/landmarks -> control/mesh
#include <optional>
#include <sstream>

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
    options_.thickness =
        parameters.number("thickness", options_.thickness, control_mesh::kThinnest, control_mesh::kThickest);
    std::istringstream names(parameters.text("template", "bust+hips"));
    const std::string folder = parameters.text("template_directory", geometry::shipped_folder("templates"));
    parameters.check_all_known();
    for (std::string name; std::getline(names, name, '+');)
      patterns_.push_back(
          control_mesh::load_template(geometry::yaml_file(folder, name, geometry::refusal::kBadTemplate)));
    if (patterns_.empty()) throw geometry::Refusal(geometry::refusal::kBadOption, "template is empty");

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
    std::string left_out;
    body->control = cover(body->mesh, measures, left_out);
    const ControlMesh message = to_message(tag_in(mesh), body->control);
    return {[this, message, body] {
              control_.publish(message);
              show(body);
            },
            {{"nodes", std::to_string(body->control.outer.size())},
             {"triangles", std::to_string(body->control.triangles.size())},
             {"left_out", left_out}}};
  }

  /// A region that this body lacks is left out, and named with the reason. \throw Refusal: none is left
  geometry::ControlMesh cover(const geometry::TriangleMesh& body, const geometry::BodyMeasures& measures,
                              std::string& left_out) const {
    std::vector<geometry::ControlMesh> parts;
    std::optional<geometry::Refusal> first;
    for (const control_mesh::Template& pattern : patterns_) {
      try {
        parts.push_back(control_mesh::fit_template(pattern, body, measures, options_));
      } catch (const geometry::Refusal& refusal) {
        if (!first) first = refusal;
        left_out += (left_out.empty() ? "" : "; ") + pattern.name + ": " + refusal.what();
      }
    }
    if (parts.empty()) throw *first;
    if (!left_out.empty()) ROS_WARN("left out: %s", left_out.c_str());
    return geometry::joined(parts);
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
  std::vector<control_mesh::Template> patterns_;
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
