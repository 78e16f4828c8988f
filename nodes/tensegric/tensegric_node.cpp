/// control/mesh + garment -> control/deformed
#include <std_srvs/Trigger.h>

#include <chrono>

#include "geometry/shipped_files.hpp"
#include "inspect/markers.hpp"
#include "ros/body_messages.hpp"
#include "ros/display.hpp"
#include "ros/garment_fitter.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/stage.hpp"
#include "ros/wardrobe.hpp"

namespace tensegric_fit::node {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Setup {
  FitterOptions fitter;
  double progress_period = 0.1;  ///< seconds between states that are published while solving
  std::string garment = "B1";    ///< worn until another is asked for, and after a reset
  std::string garment_directory = geometry::shipped_folder("garments");
};

Setup setup_from(const ros::NodeHandle& private_node) {
  Setup setup;
  Parameters parameters(private_node);
  tensegric::ModelOptions& model = setup.fitter.model;
  model.strut_stiffness = parameters.number("strut_stiffness", model.strut_stiffness,
                                            tensegric::kSoftestStrut, tensegric::kStiffestStrut);
  model.prestress = parameters.number("prestress", model.prestress, tensegric::kLowestPrestress,
                                      tensegric::kHighestPrestress);
  tensegric::SolverOptions& solver = setup.fitter.solver;
  solver.solver = tensegric::solver_from(
      parameters.choice("solver", to_string(solver.solver), {"equilibrium", "adaptive", "relaxation"}));
  solver.max_iterations = parameters.integer("max_iterations", solver.max_iterations, 0, 10000000);
  solver.time_budget = parameters.number("time_budget", solver.time_budget, 0, 3600);
  solver.volume = parameters.choice("volume", "control", {"control", "body"}) == "body"
                      ? tensegric::KeptVolume::body
                      : tensegric::KeptVolume::control;
  solver.gravity = parameters.vector("gravity", solver.gravity);
  solver.line_force = parameters.number("line_force", solver.line_force, 0, 1e6);
  solver.volume_force = parameters.number("volume_force", solver.volume_force, 0, 1e6);
  geometry::Posture& posture = setup.fitter.posture;
  posture.twist =
      parameters.number("twist", posture.twist, -geometry::kLargestTwist, geometry::kLargestTwist);
  posture.side_lean =
      parameters.number("side_lean", posture.side_lean, -geometry::kLargestLean, geometry::kLargestLean);
  setup.progress_period = parameters.number("progress_period", setup.progress_period, 0.001, 60);
  setup.garment = parameters.text("garment", setup.garment);
  setup.garment_directory = parameters.text("garment_directory", setup.garment_directory);
  parameters.check_all_known();
  return setup;
}

class TensegricNode {
 public:
  TensegricNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : setup_(setup_from(private_node)),
        wardrobe_(setup_.garment_directory),
        worn_(wardrobe_.take(setup_.garment)),
        fitter_(setup_.fitter),
        node_(node),
        fit_(node.advertise<FitState>("control/deformed", 4, true)),
        progress_(node.advertise<FitState>("control/deformed", 4)),
        display_(private_node),
        stage_("tensegric", node) {
    announce();
    const ros::TransportHints prompt = ros::TransportHints().tcpNoDelay();
    control_in_ = node.subscribe("control/mesh", 2, &TensegricNode::on_control, this, prompt);
    if (posed())
      landmarks_in_ = node.subscribe("body/landmarks", 2, &TensegricNode::on_landmarks, this, prompt);
    if (keeps_body()) body_in_ = node.subscribe("body/mesh", 2, &TensegricNode::on_body, this, prompt);
    garment_in_ = node.subscribe("garment", 8, &TensegricNode::on_garment, this, prompt);
    set_garment_ = node.advertiseService("set_garment", &TensegricNode::on_set_garment, this);
    reset_ = node.advertiseService("reset", &TensegricNode::on_reset, this);
  }

 private:
  void on_control(const ControlMesh::ConstPtr& control) {
    stage_.begin(control->scan_id);
    scene_.control = control;
    fit(true);
  }

  void on_landmarks(const Landmarks::ConstPtr& landmarks) {
    scene_.landmarks = landmarks;
    fit(true);
  }

  void on_body(const TriangleMesh::ConstPtr& body) {
    scene_.body = body;
    fit(true);
  }

  bool posed() const { return setup_.fitter.posture.twist != 0 || setup_.fitter.posture.side_lean != 0; }
  bool keeps_body() const { return setup_.fitter.solver.volume == tensegric::KeptVolume::body; }

  /// All that a fit needs has come, and is of one scan.
  bool complete() const {
    const auto fits = [this](const auto& message) {
      return message && message->scan_id == scene_.control->scan_id;
    };
    return scene_.control && (!posed() || fits(scene_.landmarks)) && (!keeps_body() || fits(scene_.body));
  }

  void on_garment(const ros::MessageEvent<Garment const>& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    try {
      put_on(request_in(*event.getMessage()), false);
      garment_.shutdown();  // late joiners get theirs, not ours
    } catch (const geometry::Refusal& refusal) {
      stage_.refuse(scene_.control ? scene_.control->scan_id : "", refusal);
    }
  }

  bool on_set_garment(SetGarment::Request& request, SetGarment::Response& response) {
    try {
      put_on(wardrobe_.take(request), false);
      announce();
      response.accepted = true;
      response.message =
          scene_.control ? "fitting to scan " + scene_.control->scan_id : "kept until a scan comes";
    } catch (const geometry::Refusal& refusal) {
      response.accepted = false;
      response.code = refusal.code();
      response.message = refusal.what();
    }
    return true;
  }

  /// Back to the first garment, from the body at rest.
  bool on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    try {
      put_on(wardrobe_.take(setup_.garment), true);
      announce();
      response.success = true;
      response.message = "garment '" + worn_.garment.name + "' from rest";
    } catch (const geometry::Refusal& refusal) {
      response.success = false;
      response.message = refusal.code() + ": " + refusal.what();
    }
    return true;
  }

  /// \throw Refusal: the garment worn before stays
  void put_on(GarmentRequest request, bool from_rest) {
    fitter_.check(request.garment);
    worn_ = std::move(request);
    fit(from_rest);
  }

  void announce() {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    if (!garment_) garment_ = node_.advertise<Garment>("garment", 1, true);
    garment_.publish(to_message(header, worn_));
  }

  void fit(bool from_rest) {
    if (!complete()) return;
    stage_.post(scene_.control->scan_id, [this, scene = scene_, request = worn_, from_rest] {
      return fit(scene, request, from_rest);
    });
  }

  Stage::Result fit(const FittingScene& scene, const GarmentRequest& request, bool from_rest) {
    const ControlMesh::ConstPtr& control = scene.control;
    const FitName name{tag_in(*control), request.garment.name, fitter_.solver_of(request)};
    const auto start = Clock::now();
    double told = 0;
    const auto progress = [&](const tensegric::Iterate& iterate, const std::vector<Eigen::Vector3d>& outer) {
      const double now = milliseconds_since(start);
      if (now - told >= 1000 * setup_.progress_period) {
        progress_.publish(to_message(name, iterate, outer, now));
        told = now;
      }
      return !stage_.outdated(control->scan_id);
    };
    std::optional<tensegric::Solution> solution = fitter_.fit(scene, request, from_rest, progress);
    if (!solution) return {};
    auto worn = std::make_shared<WornGarment>();
    worn->solution = std::move(*solution);
    worn->header = control->header;
    worn->control = fitter_.model()->control;
    const auto message =
        boost::make_shared<FitState>(to_message(name, worn->solution, milliseconds_since(start)));
    message->twist = setup_.fitter.posture.twist;
    message->side_lean = setup_.fitter.posture.side_lean;
    return {[this, message, worn] {
              fit_.publish(message);
              show(worn);
            },
            {{"garment", message->garment},
             {"solver", message->solver},
             {"status", message->status},
             {"iterations", std::to_string(message->iteration)}}};
  }

  /// What there is to show of a fit.
  struct WornGarment {
    std_msgs::Header header;
    geometry::ControlMesh control;
    tensegric::Solution solution;
  };

  void show(const std::shared_ptr<const WornGarment>& worn) {
    display_.markers.offer([=] {
      std::vector<inspect::TenseLine> lines;
      for (const tensegric::LineResult& line : worn->solution.lines)
        lines.push_back({line.nodes, line.tension});
      return inspect::Markers(worn->header)
          .control_mesh(worn->control, worn->solution.outer)
          .lines(worn->control, worn->solution.outer, lines)
          .share();
    });
    const geometry::TriangleMesh skin{worn->solution.outer, worn->control.triangles};
    display_.polygon_mesh.offer([=] { return inspect::polygon_mesh(worn->header, skin, {}); });
    display_.image.offer([=] { return front_image(worn->header, skin, {}, {}, facing(skin)); });
  }

  const Setup setup_;
  const Wardrobe wardrobe_;
  GarmentRequest worn_;
  FittingScene scene_;  // newest of each
  GarmentFitter fitter_;
  ros::NodeHandle node_;
  ros::Publisher fit_, progress_;  // one topic: how a fit ended is kept for late joiners, how it went is not
  ros::Publisher garment_;
  Display display_;
  ros::Subscriber control_in_, landmarks_in_, body_in_, garment_in_;
  ros::ServiceServer set_garment_, reset_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::TensegricNode>(argc, argv, "tensegric");
}
