/// Messages that are made only when someone listens, and kept for whoever joins later.
#pragma once

#include <ros/ros.h>

#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "ros/log_words.hpp"

namespace tensegric_fit::node {

/// Like a latched topic whose message is made on the first demand. Someone who joins in the very moment of an
/// offer can get it twice.
template <typename Message>
class KeptPublisher {
 public:
  using Make = std::function<typename Message::ConstPtr()>;

  KeptPublisher(ros::NodeHandle node, const std::string& topic) {
    publisher_ = node.advertise<Message>(
        topic, 4, [this](const ros::SingleSubscriberPublisher& newcomer) { welcome(newcomer); });
  }

  /// Takes the place of what was kept; made and published now if someone listens.
  void offer(Make make) {
    std::lock_guard<std::mutex> lock(mutex_);
    make_ = std::move(make);
    made_.reset();
    if (publisher_.getNumSubscribers() != 0) publisher_.publish(made());
  }

 private:
  void welcome(const ros::SingleSubscriberPublisher& newcomer) {
    std::lock_guard<std::mutex> lock(mutex_);
    try {
      if (make_) newcomer.publish(*made());
    } catch (const std::exception& error) {  // a node does not end because somebody looks
      ROS_ERROR("%s: %s", publisher_.getTopic().c_str(), log_words(error.what()).c_str());
    }
  }

  const typename Message::ConstPtr& made() {
    if (!made_) made_ = make_();
    return made_;
  }

  std::mutex mutex_;
  Make make_;
  typename Message::ConstPtr made_;
  ros::Publisher publisher_;
};

}  // namespace tensegric_fit::node
