/// The main function of every stage node.
#pragma once

#include <ros/ros.h>

#include <exception>
#include <string>

#include "files/owner_only.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {

/// Exit codes: 0 shut down, 1 an error nobody foresaw, 2 a parameter or file of its own was refused.
template <typename Node>
int run_node(int argc, char** argv, const std::string& name) {
  files::owner_only();
  ros::init(argc, argv, name);
  try {
    Node node(ros::NodeHandle{}, ros::NodeHandle{"~"});
    ros::spin();
    return 0;
  } catch (const geometry::Refusal& refusal) {
    ROS_FATAL("%s: %s: %s", name.c_str(), refusal.code().c_str(), refusal.what());
    return 2;
  } catch (const std::exception& error) {
    ROS_FATAL("%s: %s", name.c_str(), error.what());
    return 1;
  }
}

}  // namespace tensegric_fit::node
