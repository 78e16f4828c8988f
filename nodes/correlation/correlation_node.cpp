/// body/mesh + body/landmarks + control/mesh + body/deformed + worn/points -> worn/correlation
#include "correlation/correlation_handler.hpp"
#include "inspect/correlation_pictures.hpp"
#include "landmarks/find_landmarks.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "ros/display.hpp"
#include "ros/held_scan.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"

namespace tensegric_fit::node {
namespace {

// As reconstruction and landmarks measure the scan without the garment.
MeasureScan measure_with(Parameters& parameters) {
  return [options = reconstruction_options(parameters), anatomy = shipped_anatomy(),
          precision = landmarks::shipped_precision()](const geometry::PointCloud& scan) -> MeasuredScan {
    reconstruction::Reconstruction worn = reconstruction::reconstruct(scan, options, anatomy);
    geometry::BodyMeasures measures =
        landmarks::find_landmarks(worn.body.mesh, worn.body.filled, worn.model, precision);
    return {std::move(worn.body.mesh), std::move(worn.body.filled), std::move(measures)};
  };
}

CorrelationHandler handler_of(const ros::NodeHandle& private_node) {
  Parameters parameters(private_node);
  MeasureScan measure = measure_with(parameters);
  return CorrelationHandler(std::move(parameters), std::move(measure));
}

class CorrelationNode {
 public:
  CorrelationNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(handler_of(private_node)),
        correlation_(node.advertise<Correlation>("worn/correlation", 1, true)),
        display_(private_node),
        inputs_(node, [this](const std::string& scan_id,
                             const geometry::Refusal& why) { stage_.refuse(scan_id, why); }),
        stage_("correlation", node) {
    inputs_.subscribe_from("reconstruction", "body/mesh", 2, &CorrelationNode::on_body, this);
    inputs_.subscribe_from("landmarks", "body/landmarks", 2, &CorrelationNode::on<Landmarks>, this);
    inputs_.subscribe_from("control_mesh", "control/mesh", 2, &CorrelationNode::on<ControlMesh>, this);
    inputs_.subscribe_from("tffd", "body/deformed", 8, &CorrelationNode::on<DeformedMesh>, this);
    inputs_.subscribe("worn/points", 2, &CorrelationNode::on_worn, this);
  }

 private:
  void on_body(const TriangleMesh::ConstPtr& body) {
    stage_.begin(body->scan_id);
    on(body);
  }

  template <typename Message>
  void on(const boost::shared_ptr<const Message>& message) {
    post(handler_.add(message));
  }

  void on_worn(const sensor_msgs::PointCloud2::ConstPtr& worn) {
    const ScanTag tag = tag_of(*worn);
    if (HeldScan::of_process().is_forgotten(tag.scan_id)) return;
    try {
      const std::optional<CorrelationHandler::Input> input = handler_.add(worn, tag);
      HeldScan::of_process().begin_beside(tag.scan_id);
      post(input);
    } catch (const geometry::Refusal& refusal) {
      if (handler_.waits(tag.scan_id)) HeldScan::of_process().begin_beside(tag.scan_id);
      stage_.drop(tag.scan_id, refusal);
    }
  }

  void post(const std::optional<CorrelationHandler::Input>& input) {
    if (!input) return;
    stage_.post(handler_.scan_id(), [this, input = *input]() -> Stage::Result {
      const auto output = std::make_shared<const CorrelationHandler::Output>(handler_.handle(input));
      if (HeldScan::of_process().is_forgotten(input.worn.tag.scan_id)) return {};  // meanwhile
      return {[this, output] {
                correlation_.publish(output->correlation);
                show(output);
              },
              output->facts, output->warning};
    });
  }

  void show(const std::shared_ptr<const CorrelationHandler::Output>& output) {
    const std_msgs::Header header = output->correlation->header;
    const auto values = [output] {
      const Correlation& correlation = *output->correlation;
      return std::pair{std::vector<double>(correlation.distance.begin(), correlation.distance.end()),
                       std::vector<char>(correlation.compared.begin(), correlation.compared.end())};
    };
    const auto colours = [values] {
      const auto [distance, compared] = values();
      return inspect::distance_colours(distance, compared);
    };
    display_.markers.offer([=] {
      return inspect::Markers(header)
          .body(*output->simulated, lit_skin(*output->simulated, colours(), output->body_from_scan))
          .share();
    });
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(header, *output->simulated, colours()); });
    display_.image.offer([=] {
      const auto [distance, compared] = values();
      return inspect::image(
          header, inspect::distance_picture({*output->simulated, *output->before, *output->worn, distance,
                                             compared, output->body_from_scan,
                                             inspect::parts_of(output->control, output->body_from_scan)}));
    });
  }

  CorrelationHandler handler_;
  ros::Publisher correlation_;
  Display display_;
  WatchedInputs inputs_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::CorrelationNode>(argc, argv, "correlation");
}
