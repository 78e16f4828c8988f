/// Subscriptions that are made anew where they do not come about.
#pragma once

#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tensegric_fit::node {

/// In some test runs on a busy machine the scan player had published its latched scan, and for two minutes
/// the reconstruction waited for input, once with a connection. Why is not known. One way to it:
/// roscpp 1.15.15 asks a publisher for a connection once, and waits for ever where no answer comes
/// (tests/faults/silent_publisher.py). So where a publisher is announced and none is connected, at two looks
/// in a row, the subscription is made anew; and once where one is connected and nothing has come: what is
/// latched comes with a connection. So in an idle shop each input connects again once after its start.
class WatchedInputs {
 public:
  explicit WatchedInputs(const ros::NodeHandle& node)
      : node_(node),
        watch_(node.createWallTimer(ros::WallDuration(kSeconds),
                                    [this](const ros::WallTimerEvent&) { look(); })) {}
  WatchedInputs(const WatchedInputs&) = delete;
  WatchedInputs& operator=(const WatchedInputs&) = delete;

  /// As NodeHandle::subscribe for a method of a node.
  template <typename Argument, typename Node>
  void subscribe(const std::string& topic, std::uint32_t queue, void (Node::*method)(Argument), Node* node,
                 const ros::TransportHints& hints = {}) {
    const auto heard = std::make_shared<std::atomic<bool>>(false);
    const boost::function<void(Argument)> hear = [heard, method, node](Argument message) {
      *heard = true;
      (node->*method)(message);
    };
    const auto subscribe = [this, topic, queue, hear, hints] {
      return node_.subscribe<Argument>(topic, queue, hear, ros::VoidConstPtr(), hints);
    };
    inputs_.push_back({subscribe, subscribe(), heard});
  }

 private:
  static constexpr double kSeconds = 3;  // a negotiation takes milliseconds

  struct Input {
    std::function<ros::Subscriber()> subscribe;
    ros::Subscriber subscriber;
    std::shared_ptr<std::atomic<bool>> heard;
    bool lacked = false;          // at the last look
    bool connected_anew = false;  // though one was connected
  };

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
      input.subscriber.shutdown();
      input.subscriber = input.subscribe();
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
  std::vector<Input> inputs_;
  ros::WallTimer watch_;
};

}  // namespace tensegric_fit::node
