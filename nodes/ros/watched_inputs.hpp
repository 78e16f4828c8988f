/// Subscriptions that are made anew where they do not come about, or where a message was lost.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <tensegric_fit/FitState.h>

#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "geometry/status.hpp"
#include "ros/held_scan.hpp"
#include "ros/lost_messages.hpp"
#include "ros/stage_report_message.hpp"

namespace tensegric_fit::node {

/// In some test runs on a busy machine the scan player had published its latched scan, and for two minutes
/// the reconstruction waited for input, once with a connection. Why is not known. One way to it:
/// roscpp 1.15.15 asks a publisher for a connection once, and waits for ever where no answer comes
/// (tests/faults/silent_publisher.py). So where a publisher is announced and none is connected, at two looks
/// in a row, the subscription is made anew; and once where one is connected and nothing has come: what is
/// latched comes with a connection. So in an idle shop each input connects again once after its start.
///
/// A message can also be lost between two stages, by a proxy or a bridge in between: the stage before says on
/// /diagnostics that it is done with a scan, and nothing of that scan comes. Then, too, the subscription is
/// made anew, and if that does not help either, the scan is refused by name (`lost_message`). A message that
/// the next scan's has overtaken there is not taken, nor a state on the way to a result that has come.
///
/// Nor is a message of a scan to be forgotten: it comes from a node that has yet to let go of it.
class WatchedInputs {
 public:
  using OnLost = std::function<void(const std::string& scan_id, const geometry::Refusal& refusal)>;

  explicit WatchedInputs(const ros::NodeHandle& node, OnLost on_lost = {})
      : node_(node),
        on_lost_(std::move(on_lost)),
        reports_(node_.subscribe("/diagnostics", 100, &WatchedInputs::hear_reports, this,
                                 ros::TransportHints().tcpNoDelay())),  // not after what they announce
        watch_(node.createWallTimer(ros::WallDuration(kSeconds),
                                    [this](const ros::WallTimerEvent&) { look(); })) {}
  WatchedInputs(const WatchedInputs&) = delete;
  WatchedInputs& operator=(const WatchedInputs&) = delete;

  /// As NodeHandle::subscribe for a method of a node.
  template <typename Argument, typename Node>
  void subscribe(const std::string& topic, std::uint32_t queue, void (Node::*method)(Argument), Node* node,
                 const ros::TransportHints& hints = {}) {
    const auto take = [method, node](Argument message) {
      if (!is_of_forgotten(message)) (node->*method)(message);
    };
    add<Argument>("", topic, queue, take, hints);
  }

  /// The same for what stage `from` publishes of each scan.
  template <typename Message, typename Node>
  void subscribe_from(const std::string& from, const std::string& topic, std::uint32_t queue,
                      void (Node::*method)(const boost::shared_ptr<const Message>&), Node* node,
                      const ros::TransportHints& hints = {}) {
    const auto losses = std::make_shared<LostMessages>();
    const auto late = std::make_shared<Late>();
    const auto take = [losses, late, method, node](const boost::shared_ptr<const Message>& message) {
      const auto give = [losses, method, node, message] {
        if (!is_passing(*message, 0))
          losses->heard(message->scan_id);
        else if (losses->is_late(message->scan_id))
          return;
        if (!is_of_forgotten(message)) (node->*method)(message);
      };
      if (!losses->is_overtaken(message->scan_id))
        give();
      else if (!is_of_forgotten(message)) {
        HeldScan::of_process().begin_beside(message->scan_id);
        *late = {message->scan_id, give};
      }
    };
    add<const boost::shared_ptr<const Message>&>(from, topic, queue, take, hints);
    inputs_.back().losses = losses;
    inputs_.back().late = late;
  }

 private:
  static constexpr double kSeconds = 3;  // a negotiation takes milliseconds

  /// A message that was overtaken by that of the next scan. It waits: its stage may do a scan once more.
  struct Late {
    std::string scan_id;
    std::function<void()> give;
  };

  struct Input {
    std::string from;  // a stage; empty: losses are not looked for
    std::function<ros::Subscriber()> subscribe;
    ros::Subscriber subscriber;
    std::shared_ptr<std::atomic<bool>> heard;
    std::shared_ptr<LostMessages> losses;
    std::shared_ptr<Late> late;
    bool lacked = false;          // at the last look
    bool connected_anew = false;  // though one was connected

    void subscribe_anew() {
      subscriber.shutdown();
      subscriber = subscribe();
    }
  };

  template <typename Argument>
  void add(const std::string& from, const std::string& topic, std::uint32_t queue,
           const std::function<void(Argument)>& take, const ros::TransportHints& hints) {
    const auto heard = std::make_shared<std::atomic<bool>>(false);
    const boost::function<void(Argument)> hear = [heard, take](Argument message) {
      *heard = true;
      take(message);
    };
    const auto subscribe = [this, topic, queue, hear, hints] {
      return node_.subscribe<Argument>(topic, queue, hear, ros::VoidConstPtr(), hints);
    };
    inputs_.push_back({from, subscribe, subscribe(), heard, nullptr, nullptr});
  }

  /// A state of the solver, on the way to a fit.
  template <typename Message>
  static auto is_passing(const Message& message, int) -> decltype(message.status == FitState::SOLVING) {
    return message.status == FitState::SOLVING;
  }
  template <typename Message>
  static bool is_passing(const Message&, long) {
    return false;
  }

  void hear_reports(const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
    for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
      const auto report = stage_report_in(status, node_.getNamespace());
      if (!report) continue;
      for (Input& input : inputs_) {
        if (!input.losses || input.from != report->stage) continue;
        if (report->state == "working") input.losses->working(report->scan_id);
        if (report->state == "done") look_for_loss(input, report->scan_id);
      }
    }
  }

  void look_for_loss(Input& input, const std::string& scan_id) {
    const double now = ros::SteadyTime::now().toSec();
    input.losses->sent(scan_id, now);
    if (input.late->give && input.late->scan_id == scan_id) std::exchange(*input.late, Late()).give();
    switch (input.losses->advice(now)) {
      case LostMessages::Advice::wait:
        break;
      case LostMessages::Advice::connect_anew:
        input.subscribe_anew();
        break;
      case LostMessages::Advice::give_up:
        on_lost_(scan_id, geometry::Refusal(geometry::refusal::kLostMessage,
                                            input.from + " is done with it, but nothing of it came on " +
                                                input.subscriber.getTopic()));
    }
  }

  void look() {
    bool any = false;
    for (Input& input : inputs_) {
      if (input.subscriber.getNumPublishers() == 0) input.connected_anew = false;
      any |= lacks(input);
    }
    if (!any) return;
    const std::set<std::string> announced = announced_topics();
    for (Input& input : inputs_) {
      const std::string topic = input.subscriber.getTopic();
      const bool lacks_it = lacks(input) && announced.count(topic) > 0;
      const bool again = lacks_it && input.lacked;
      input.lacked = lacks_it && !again;
      if (!again) continue;
      input.connected_anew = input.subscriber.getNumPublishers() > 0;
      if (!input.connected_anew)
        ROS_WARN("%s: a publisher is announced and not connected; subscribed anew", topic.c_str());
      input.subscribe_anew();
    }
  }

  static bool lacks(const Input& input) {
    return input.subscriber.getNumPublishers() == 0 || (!*input.heard && !input.connected_anew);
  }

  /// What the master knows publishers of; nothing where it does not answer.
  static std::set<std::string> announced_topics() {
    XmlRpc::XmlRpcValue request, response, topics;
    request[0] = ros::this_node::getName();
    request[1] = "";
    std::set<std::string> names;
    if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return names;
    for (int i = 0; i < topics.size(); ++i) names.insert(std::string(topics[i][0]));
    return names;
  }

  ros::NodeHandle node_;
  OnLost on_lost_;
  std::vector<Input> inputs_;
  ros::Subscriber reports_;
  ros::WallTimer watch_;
};

}  // namespace tensegric_fit::node
