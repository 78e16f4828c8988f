/// Triggers a scan of a booth.
#pragma once

#include <ros/node_handle.h>

#include <future>
#include <string>

namespace tensegric_fit::node {

/// A std_srvs/Trigger service that scans the person in the booth and answers when that is over. It is called
/// in a thread of its own. For one thread.
class BoothTrigger {
 public:
  /// `service` may be empty: a booth that scans by itself.
  BoothTrigger(const ros::NodeHandle& node, std::string service)
      : node_(node), service_(std::move(service)) {}

  /// False, and nothing done, while an earlier call is under way.
  bool pull();

  /// What went wrong with a call that has ended, once; empty where nothing did.
  std::string complaint();

 private:
  ros::NodeHandle node_;
  const std::string service_;
  std::future<std::string> call_;
};

}  // namespace tensegric_fit::node
