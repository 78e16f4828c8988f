/// capture: the action that a shop's programs call for each customer.
#include <actionlib/server/simple_action_server.h>
#include <fmt/format.h>
#include <std_srvs/Trigger.h>
#include <tensegric_fit/CaptureAction.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <map>
#include <memory>
#include <thread>

#include "capture/capture_handler.hpp"
#include "geometry/status.hpp"
#include "ros/held_scan.hpp"
#include "ros/log_words.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

using sensor_msgs::PointCloud2;

constexpr double kLatched = 1;     // s until a node that starts has heard what was there before
constexpr double kConnecting = 2;  // s that sensors may take to be connected to before the trigger is pulled
constexpr double kTick = 0.1;      // s
constexpr int kIdle = 3;           // ticks since the last goal: its result is on its way
constexpr double kStep = 0.5;      // s that a clock is set back by; less is over before the next goal

double now() {
  return ros::SteadyTime::now().toSec();
}

/// A std_srvs/Trigger service that scans the person in the booth and answers when that is over. It is called
/// in a thread of its own, which is left alone where it still waits at the end: a booth that hangs holds
/// nothing else up. For one thread.
class BoothTrigger {
 public:
  /// `service` may be empty: a booth that scans by itself.
  BoothTrigger(const ros::NodeHandle& node, std::string service)
      : node_(node), service_(std::move(service)) {}

  /// False, and nothing done, while an earlier call is under way.
  bool pull() {
    if (call_.valid()) return false;
    std::packaged_task<std::string()> call(
        [client = node_.serviceClient<std_srvs::Trigger>(service_)]() mutable -> std::string {
          std_srvs::Trigger trigger;
          if (!client.call(trigger)) return client.getService() + " did not answer";
          return trigger.response.success ? "" : client.getService() + ": " + trigger.response.message;
        });
    call_ = call.get_future();
    std::thread(std::move(call)).detach();
    return true;
  }

  bool is_under_way() const { return call_.valid(); }

  /// What went wrong with a call that has ended, once; empty where nothing did.
  std::string complaint() {
    if (!call_.valid() || call_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return "";
    return call_.get();
  }

 private:
  ros::NodeHandle node_;
  const std::string service_;
  std::future<std::string> call_;
};

class CaptureNode {
 public:
  CaptureNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : node_(node),
        handler_(
            Parameters(private_node), node.getNamespace(),
            Parameters(ros::NodeHandle(node, "assembler"))
                .number("slop", geometry::kUsualSlop, geometry::kSlop)),  // clouds within it are one scan
        trigger_(node, handler_.trigger()) {
    subscribers_ = {node.subscribe("scan/points", 4, &CaptureNode::on_scan, this),
                    node.subscribe("body/landmarks", 4, &CaptureNode::on_landmarks, this),
                    node.subscribe("/diagnostics", 100, &CaptureNode::on_diagnostics, this)};
    clock_ = node.createWallTimer(ros::WallDuration(kTick), [this](const ros::WallTimerEvent&) { go_on(); });
    const auto open = [this](const ros::WallTimerEvent&) { serve(); };
    opening_ = node.createWallTimer(ros::WallDuration(kLatched), open, true);
  }

  /// Nothing is kept after a goal: if it restarted, it would miss the next customer's.
  void forget(const ForgetOrder& order, ForgetAnswer& done) {
    if (!handler_.forget(order.scan_id)) return;
    finish(handler_.refused(geometry::refusal::kSuperseded, "the scan was to be forgotten"));
    done.removed = {"its goal"};
  }

 private:
  void serve() {
    server_.reset();  // first: the topics are the same
    server_ = std::make_unique<Server>(node_, "capture", false);
    server_->registerGoalCallback([this] { on_goal(); });
    server_->registerPreemptCallback([this] { on_preempt(); });
    server_->start();
  }

  /// actionlib drops goals that are stamped before its last one: for an hour where the clock was set back by
  /// one.
  void follow_clock() {
    const double time = ros::Time::now().toSec();
    went_back_ = went_back_ || time < newest_ - kStep;
    newest_ = went_back_ ? time : std::max(newest_, time);
    idle_ = handler_.is_busy() ? 0 : idle_ + 1;
    if (!went_back_ || !server_ || idle_ < kIdle) return;
    serve();
    went_back_ = false;
  }

  void on_goal() {
    goal_ = server_->acceptNewGoal();
    try {
      handler_.begin(*goal_, now());
      for (const std::string& sensor : goal_->sensors) listen_to(sensor);
    } catch (const geometry::Refusal& refusal) {
      handler_.stop();
      return finish(refused(refusal.code(), refusal.what()));
    }
    deformed_ = goal_->with_fit ? node_.subscribe("body/deformed", 4, &CaptureNode::on_deformed, this)
                                : ros::Subscriber();
  }

  void on_preempt() {
    handler_.stop();
    if (!server_->isNewGoalAvailable()) server_->setPreempted();  // else the new goal takes its place
  }

  static CaptureResult refused(const std::string& code, const std::string& message) {
    CaptureResult result;
    result.code = code;
    result.message = message;
    return result;
  }

  /// For good: later goals may come faster than sensors can be connected to.
  void listen_to(const std::string& sensor) {
    if (sensors_.count(sensor) != 0) return;
    const boost::function<void(const PointCloud2::ConstPtr&)> on_cloud =
        [this, sensor](const PointCloud2::ConstPtr& cloud) { handler_.add(sensor, *cloud, now()); };
    try {
      sensors_[sensor] = node_.subscribe<PointCloud2>(sensor, 4, on_cloud);
    } catch (const ros::Exception& error) {  // no name of a topic, or a topic of another type
      sensors_.erase(sensor);
      throw geometry::Refusal(geometry::refusal::kBadOption,
                              fmt::format("sensor '{}': {}", sensor, error.what()));
    }
  }

  void on_scan(const PointCloud2::ConstPtr& scan) {
    if (!HeldScan::of_process().is_forgotten(tag_of(*scan).scan_id)) handler_.add(*scan);
  }
  void on_landmarks(const Landmarks::ConstPtr& landmarks) { handler_.add(landmarks); }
  void on_deformed(const DeformedMesh::ConstPtr& deformed) { handler_.add(*deformed); }
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
    handler_.add(*message, now());
  }

  void pull_trigger() {
    for (const std::string& sensor : goal_->sensors)
      if (sensors_[sensor].getNumPublishers() == 0 && now() - handler_.begun() < kConnecting) return;
    const std::uint64_t stamp = ros::Time::now().toNSec();
    if (trigger_.pull()) handler_.pulled(stamp);  // else an earlier customer's is still held
  }

  void go_on() {
    follow_clock();
    const std::string complaint = trigger_.complaint();
    if (!handler_.is_busy()) return;
    const bool waited = handler_.waits_for_trigger();
    if (waited) pull_trigger();
    handler_.set_unanswered(trigger_.is_under_way());
    if (!waited && !complaint.empty())  // else it is about an earlier customer's
      finish(handler_.refused(geometry::refusal::kTriggerFailed, complaint));
    else if (const auto result = handler_.result(now()))
      finish(*result);
    else
      server_->publishFeedback(handler_.feedback(now()));
  }

  void finish(const CaptureResult& result) {
    deformed_.shutdown();
    const std::string what = (result.measured ? "measured" : result.code) + " " + result.message;
    ROS_INFO("capture: scan %s: %s", result.scan_id.c_str(), log_words(what).c_str());
    if (result.measured)
      server_->setSucceeded(result);
    else
      server_->setAborted(result,
                          "refused");  // the status is published until the next goal: the result says why
  }

  using Server = actionlib::SimpleActionServer<CaptureAction>;

  ros::NodeHandle node_;
  CaptureHandler handler_;
  std::map<std::string, ros::Subscriber> sensors_;
  ros::Subscriber deformed_;
  std::vector<ros::Subscriber> subscribers_;
  BoothTrigger trigger_;
  std::unique_ptr<Server> server_;  // null until it is opened
  Server::GoalConstPtr goal_;
  double newest_ = 0;  // s, of the clock that goals are stamped by
  bool went_back_ = false;
  int idle_ = 0;  // ticks in a row
  ros::WallTimer clock_, opening_;
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::CaptureNode>(argc, argv, "capture");
}
