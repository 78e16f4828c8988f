/// capture: the action that a shop's programs call for each customer.
#include <actionlib/server/simple_action_server.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/CaptureAction.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/Landmarks.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <memory>

#include "booth/booth_trigger.hpp"
#include "booth/capture_watch.hpp"
#include "booth/stage_reports.hpp"
#include "geometry/status.hpp"
#include "ros/parameters.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

using sensor_msgs::PointCloud2;

constexpr double kLatched = 1;     // s until a node that starts has heard what was there before
constexpr double kConnecting = 2;  // s that sensors may take to be connected to before the trigger is pulled
constexpr double kTick = 0.1;      // s
constexpr std::size_t kRemembered = 64;  // scans
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

struct Setup {
  double timeout, slop;
  std::string trigger;
};

Setup setup_from(Parameters parameters) {
  Setup setup;
  setup.timeout = parameters.number("timeout", 60, 0.1, 3600);
  setup.slop = parameters.number("slop", 0.2, 0, 60);
  setup.trigger = parameters.text("trigger", "");
  parameters.check_all_known();
  return setup;
}

double now() {
  return ros::SteadyTime::now().toSec();
}

class CaptureNode {
 public:
  CaptureNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : setup_(setup_from(Parameters(private_node))),
        node_(node),
        trigger_(node, setup_.trigger),
        server_(node, "capture", false) {
    subscribers_ = {node.subscribe("scan/points", 4, &CaptureNode::on_scan, this),
                    node.subscribe("body/landmarks", 4, &CaptureNode::on_landmarks, this),
                    node.subscribe("/diagnostics", 100, &CaptureNode::on_diagnostics, this)};
    server_.registerGoalCallback([this] { on_goal(); });
    server_.registerPreemptCallback([this] { on_preempt(); });
    clock_ = node.createWallTimer(ros::WallDuration(kTick), [this](const ros::WallTimerEvent&) { go_on(); });
    const auto open = [this](const ros::WallTimerEvent&) { server_.start(); };
    opening_ = node.createWallTimer(ros::WallDuration(kLatched), open, true);
  }

 private:
  void on_goal() {
    goal_ = server_.acceptNewGoal();
    begun_ = now();
    landmarks_.clear();
    fit_status_.clear();
    for (const std::string& sensor : goal_->sensors) listen_to(sensor);
    deformed_ = goal_->with_fit ? node_.subscribe("body/deformed", 4, &CaptureNode::on_deformed, this)
                                : ros::Subscriber();
    armed_ = setup_.trigger.empty();
    begin(armed_ ? 0 : kNever);
  }

  void on_preempt() {
    watch_.reset();
    if (!server_.isNewGoalAvailable()) server_.setPreempted();  // else the new goal takes its place
  }

  /// For good: later goals may come faster than sensors can be connected to.
  void listen_to(const std::string& sensor) {
    if (sensors_.count(sensor) != 0) return;
    const boost::function<void(const PointCloud2::ConstPtr&)> on_cloud =
        [this, sensor](const PointCloud2::ConstPtr& cloud) {
          if (watch_) watch_->add_cloud(sensor, cloud->header.stamp.toNSec());
        };
    sensors_[sensor] = node_.subscribe<PointCloud2>(sensor, 4, on_cloud);
  }

  void begin(std::uint64_t not_before) {
    const double timeout = goal_->timeout > 0 ? goal_->timeout : setup_.timeout;
    watch_ = std::make_unique<booth::CaptureWatch>(
        booth::CaptureGoal{goal_->sensors, timeout, static_cast<bool>(goal_->with_fit), not_before}, board_,
        setup_.slop, begun_);
  }

  void pull_trigger() {
    for (const std::string& sensor : goal_->sensors)
      if (sensors_[sensor].getNumPublishers() == 0 && now() - begun_ < kConnecting) return;
    const std::uint64_t pulled = ros::Time::now().toNSec();
    if (!trigger_.pull()) return;  // an earlier customer's is still held
    armed_ = true;
    begin(pulled);
  }

  void go_on() {
    const std::string complaint = trigger_.complaint();
    if (!watch_) return;
    if (!armed_) pull_trigger();
    if (armed_ && !complaint.empty())
      finish({geometry::refusal::kTriggerFailed, complaint});
    else if (const auto end = watch_->end(now()))
      finish(*end);
    else
      tell();
  }

  void tell() {
    const booth::CaptureProgress progress = watch_->progress(now());
    CaptureFeedback feedback;
    feedback.stage = progress.stage;
    feedback.progress = progress.share;
    feedback.message = progress.message;
    feedback.scan_id = watch_->scan_id();
    feedback.missing = progress.missing;
    server_.publishFeedback(feedback);
  }

  void finish(const booth::CaptureEnd& end) {
    CaptureResult result;
    result.measured = end.code.empty();
    result.code = end.code;
    result.message = end.message;
    result.scan_id = watch_->scan_id();
    if (result.measured) {
      result.landmarks = *landmarks_.at(result.scan_id);
      if (goal_->with_fit) result.fit_status = fit_status_.at(result.scan_id);
    }
    watch_.reset();
    deformed_.shutdown();
    ROS_INFO("capture: scan %s: %s %s", result.scan_id.c_str(),
             result.measured ? "measured" : result.code.c_str(), result.message.c_str());
    if (result.measured)
      server_.setSucceeded(result);
    else
      server_.setAborted(result, result.code + ": " + result.message);
  }

  void on_scan(const PointCloud2::ConstPtr& scan) {
    const std::string scan_id = tag_of(*scan).scan_id;
    if (std::find(seen_.begin(), seen_.end(), scan_id) != seen_.end())
      return;  // a node sends its last one again
    seen_.push_back(scan_id);
    if (seen_.size() > kRemembered) seen_.pop_front();
    if (watch_) watch_->add_scan(scan_id, scan->header.stamp.toNSec());
  }

  void on_landmarks(const Landmarks::ConstPtr& landmarks) {
    if (!watch_) return;
    landmarks_[landmarks->scan_id] = landmarks;
    watch_->add_landmarks(landmarks->scan_id);
  }

  void on_deformed(const DeformedMesh::ConstPtr& deformed) {
    if (!watch_) return;
    fit_status_[deformed->scan_id] = deformed->status;
    watch_->add_fit(deformed->scan_id);
  }

  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message->status) {
      const auto report = stage_report_in(status, node_.getNamespace());
      if (!report) continue;
      const auto& [stage, said] = *report;
      if (board_.report(stage, said, now()) && watch_ && armed_) watch_->add_refusal(stage, said);
    }
  }

  using Server = actionlib::SimpleActionServer<CaptureAction>;

  const Setup setup_;
  ros::NodeHandle node_;
  booth::StageBoard board_;
  std::deque<std::string> seen_;  // scans
  std::map<std::string, ros::Subscriber> sensors_;
  std::vector<ros::Subscriber> subscribers_;
  BoothTrigger trigger_;
  Server server_;
  ros::WallTimer clock_, opening_;

  // of the goal at hand
  Server::GoalConstPtr goal_;
  double begun_ = 0;
  bool armed_ = false;                          // the trigger was pulled, or there is none
  std::unique_ptr<booth::CaptureWatch> watch_;  // null: no goal
  ros::Subscriber deformed_;
  std::map<std::string, Landmarks::ConstPtr> landmarks_;  // by scan
  std::map<std::string, std::string> fit_status_;         // by scan
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::CaptureNode>(argc, argv, "capture");
}
