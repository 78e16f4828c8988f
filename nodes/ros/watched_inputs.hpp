/// Subscriptions that are made anew where they do not come about.
#pragma once

#include <ros/ros.h>

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tensegric_fit::node {

/// In two test runs the scan player had published its latched scan, and for two minutes the reconstruction
/// waited for input. Why is not known. One way to it: roscpp 1.15.15 asks a publisher for a connection once,
/// and waits for ever where no answer comes (tests/faults/silent_publisher.py). So where a publisher is
/// announced and none is connected, at two looks in a row, the subscription is made anew.
class WatchedInputs {
 public:
  using Subscribe = std::function<ros::Subscriber()>;

  explicit WatchedInputs(const ros::NodeHandle& node)
      : node_(node),
        watch_(node.createWallTimer(ros::WallDuration(kSeconds),
                                    [this](const ros::WallTimerEvent&) { look(); })) {}
  WatchedInputs(const WatchedInputs&) = delete;
  WatchedInputs& operator=(const WatchedInputs&) = delete;

  /// As NodeHandle::subscribe for a method of a node.
  template <typename... Arguments>
  void subscribe(const std::string& topic, const Arguments&... arguments) {
    add([=]() mutable { return node_.subscribe(topic, arguments...); });
  }
  void add(const Subscribe& subscribe) { inputs_.push_back({subscribe, subscribe(), false}); }

 private:
  static constexpr double kSeconds = 3;  // a negotiation takes milliseconds

  struct Input {
    Subscribe subscribe;
    ros::Subscriber subscriber;
    bool lacked;
  };

  void look() {
    bool any = false;
    for (const Input& input : inputs_) any |= input.subscriber.getNumPublishers() == 0;
    if (!any) return;
    const std::set<std::string> announced = announced_topics();
    for (Input& input : inputs_) {
      const std::string topic = input.subscriber.getTopic();
      const bool lacks = input.subscriber.getNumPublishers() == 0 && announced.count(topic) > 0;
      const bool again = lacks && input.lacked;
      input.lacked = lacks && !again;
      if (!again) continue;
      ROS_WARN("%s: a publisher is announced and not connected; subscribed anew", topic.c_str());
      input.subscriber.shutdown();
      input.subscriber = input.subscribe();
    }
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
  std::vector<Input> inputs_;
  ros::WallTimer watch_;
};

}  // namespace tensegric_fit::node
