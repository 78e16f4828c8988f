/// A subscription that is made anew where it does not come about.
#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>
#include <utility>

namespace tensegric_fit::node {

/// In two test runs the scan player had published its latched scan, and for two minutes the reconstruction
/// waited for input. Why is not known. One way to it: roscpp 1.15.15 asks a publisher for a connection once,
/// and waits for ever where no answer comes (tests/faults/silent_publisher.py). So where a publisher is
/// announced and none is connected, at two looks in a row, the subscription is made anew.
class WatchedInput {
 public:
  using Subscribe = std::function<ros::Subscriber()>;

  WatchedInput(const ros::NodeHandle& node, Subscribe subscribe)
      : subscribe_(std::move(subscribe)),
        subscriber_(subscribe_()),
        watch_(node.createWallTimer(ros::WallDuration(kSeconds),
                                    [this](const ros::WallTimerEvent&) { look(); })) {}
  WatchedInput(const WatchedInput&) = delete;
  WatchedInput& operator=(const WatchedInput&) = delete;

 private:
  static constexpr double kSeconds = 3;  // a negotiation takes milliseconds

  void look() {
    const bool lacks = subscriber_.getNumPublishers() == 0 && is_announced(subscriber_.getTopic());
    const bool again = lacks && lacked_;
    lacked_ = lacks && !again;
    if (!again) return;
    ROS_WARN("%s: a publisher is announced and not connected; subscribed anew",
             subscriber_.getTopic().c_str());
    subscriber_.shutdown();
    subscriber_ = subscribe_();
  }

  /// Whether the master knows a publisher; false where it does not answer.
  static bool is_announced(const std::string& topic) {
    XmlRpc::XmlRpcValue request, response, topics;
    request[0] = ros::this_node::getName();
    request[1] = "";
    if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return false;
    for (int i = 0; i < topics.size(); ++i)
      if (std::string(topics[i][0]) == topic) return true;
    return false;
  }

  const Subscribe subscribe_;
  ros::Subscriber subscriber_;
  bool lacked_ = false;
  ros::WallTimer watch_;
};

}  // namespace tensegric_fit::node
