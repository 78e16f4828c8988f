/// Whether others in the network reach this process.
#pragma once

namespace tensegric_fit::node {

/// By ROS_HOSTNAME and ROS_IP, as roscpp decides it for topics.
bool is_for_this_machine_only();

}  // namespace tensegric_fit::node
