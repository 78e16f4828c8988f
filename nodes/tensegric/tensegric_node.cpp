/// control/mesh + control/coarse + garment -> control/deformed, control/forces
#include <std_srvs/Trigger.h>

#include "fit/bind_body.hpp"
#include "ros/display.hpp"
#include "ros/held_scan.hpp"
#include "ros/markers.hpp"
#include "ros/run_node.hpp"
#include "ros/set_parameter.hpp"
#include "ros/stage.hpp"
#include "ros/watched_inputs.hpp"
#include "tensegric/tensegric_handler.hpp"

namespace tensegric_fit::node {
namespace {

class TensegricNode {
 public:
  TensegricNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : handler_(Parameters(private_node), fit::bind_body),
        private_node_(private_node),
        fit_(node.advertise<FitState>("control/deformed", 4, true)),
        progress_(node.advertise<FitState>("control/deformed", 4)),
        forces_(node.advertise<LineForces>("control/forces", 4, true)),
        garment_(node.advertise<Garment>("garment", 1, true)),
        display_(private_node),
        members_(private_node, "members"),
        bands_(node, "control/bands"),
        inputs_(node, [this](const std::string& scan_id,
                             const geometry::Refusal& why) { stage_.refuse(scan_id, why); }),
        stage_("tensegric", node) {
    announce();
    inputs_.subscribe_from("control_mesh", "control/mesh", 2, &TensegricNode::on<ControlMesh>, this, kPrompt);
    inputs_.subscribe("control/coarse", 2, &TensegricNode::on_coarse, this, kPrompt);
    inputs_.subscribe_from("reconstruction", "body/mesh", 2, &TensegricNode::on_body, this, kPrompt);
    inputs_.subscribe("garment", 8, &TensegricNode::on_garment, this, kPrompt);
    if (handler_.needs_landmarks())
      inputs_.subscribe_from("landmarks", "body/landmarks", 2, &TensegricNode::on<Landmarks>, this, kPrompt);
    services_ = {node.advertiseService("set_garment", &TensegricNode::on_set_garment, this),
                 node.advertiseService("reset", &TensegricNode::on_reset, this)};
  }

 private:
  using Input = TensegricHandler::Input;
  using Output = TensegricHandler::Output;
  inline static const ros::TransportHints kPrompt = ros::TransportHints().tcpNoDelay();

  void on_body(const TriangleMesh::ConstPtr& body) {
    stage_.begin(body->scan_id);
    on(body);
  }

  void on_coarse(const ControlMesh::ConstPtr& coarse) { handler_.add_coarse(coarse); }

  template <typename Message>
  void on(const boost::shared_ptr<const Message>& message) {
    const std::optional<Input> input = handler_.add(message);
    if (input && !input->taken_off.empty()) {
      stage_.drop("",  // it is no fault of this scan
                  geometry::Refusal(geometry::refusal::kBadGarment,
                                    input->taken_off + "; '" + input->request.garment.name + "' is worn"));
      announce();
      keep();
    }
    fit(input);
  }

  void on_garment(const ros::MessageEvent<Garment const>& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    const ros::M_string& connection = event.getConnectionHeader();
    const auto latching = connection.find("latching");
    const bool latched = latching != connection.end() && latching->second == "1";
    try {
      put_on(handler_.put_on(*event.getMessage(), event.getPublisherName(), latched));
      announce();  // for late joiners: who asked for it may be gone by then
    } catch (const geometry::Refusal& refusal) {
      keep();                    // that it was heard
      stage_.drop("", refusal);  // the fit of the garment before stands
      announce();                // else `garment` says that the other is worn
    }
  }

  bool on_set_garment(SetGarment::Request& request, SetGarment::Response& response) {
    try {
      put_on(handler_.put_on(request));
      announce();
      response.accepted = true;
      response.message = handler_.outlook();
    } catch (const geometry::Refusal& refusal) {
      response.accepted = false;
      response.code = refusal.code();
      response.message = refusal.what();
    }
    return true;
  }

  bool on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    try {
      put_on(handler_.reset());
      announce();
      response.success = true;
      response.message = "garment '" + handler_.worn().garment.name + "' from rest: " + handler_.outlook();
    } catch (const geometry::Refusal& refusal) {
      response.success = false;
      response.message = refusal.code() + ": " + refusal.what();
    }
    return true;
  }

  void put_on(const std::optional<Input>& input) {
    fit(input);
    keep();
  }

  // For the next life of this node.
  void keep() {
    set_parameter(private_node_, "worn", handler_.kept());
    set_parameter(private_node_, "heard", handler_.heard());
  }

  void announce() {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    garment_.publish(to_message(header, handler_.worn()));
  }

  void fit(const std::optional<Input>& input) {
    if (!input) return;
    const std::string scan_id = input->control->scan_id;
    stage_.post(scan_id, [this, input = *input, scan_id]() -> Stage::Result {
      const auto output = handler_.handle(
          input, [&] { return !stage_.outdated(scan_id); },
          [&](const FitState& state) {
            if (!HeldScan::of_process().is_forgotten(scan_id)) progress_.publish(state);
          });
      if (!output) return {};
      return {[this, output = std::make_shared<const Output>(*output)] { publish(output); }, output->facts};
    });
  }

  void publish(const std::shared_ptr<const Output>& output) {
    forces_.publish(output->forces);  // first, as who shows the fit shows them with it
    fit_.publish(output->fit);
    const std_msgs::Header header = output->fit->header;
    display_.markers.offer([=] {
      std::vector<inspect::TenseLine> lines;
      for (const tensegric::LineResult& line : output->solution.lines)
        lines.push_back({line.name, line.nodes, line.tension, line.course_at_rest, line.course});
      return inspect::Markers(header)
          .control_mesh(output->model->control, output->solution.outer)
          .lines(output->model->control, output->solution.outer, lines)
          .share();
    });
    members_.offer([=] {
      return boost::make_shared<MemberForces>(
          to_message(tag_in(*output->fit), output->fit->garment, *output->model, output->solution));
    });
    bands_.offer(
        [=] { return boost::make_shared<BandShapes>(bands_message(output->name, output->solution)); });
    const geometry::TriangleMesh skin{output->solution.outer, output->model->control.triangles};
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(header, skin, {}); });
    display_.image.offer([=] { return front_image(header, skin, {}, {}, facing(skin)); });
  }

  TensegricHandler handler_;
  ros::NodeHandle private_node_;
  ros::Publisher fit_, progress_;  // one topic: how a fit ended is kept for late joiners, how it went is not
  ros::Publisher forces_, garment_;
  Display display_;
  KeptPublisher<MemberForces> members_;
  KeptPublisher<BandShapes> bands_;
  WatchedInputs inputs_;
  std::vector<ros::ServiceServer> services_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::TensegricNode>(argc, argv, "tensegric");
}
