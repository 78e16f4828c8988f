/// Parameters that a node writes.
#pragma once

#include <ros/ros.h>

#include <string>

namespace tensegric_fit::node {

/// As NodeHandle::setParam, but without waiting for a master that is gone: the node serves on, and its
/// parameter stays as it was.
inline void set_parameter(const ros::NodeHandle& node, const std::string& name,
                          const XmlRpc::XmlRpcValue& value) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = node.resolveName(name);
  request[2] = value;
  ros::master::execute("setParam", request, response, payload, false);
}

}  // namespace tensegric_fit::node
