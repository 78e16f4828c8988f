/// A stage's parameters, each checked.
#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "geometry/range.hpp"

namespace tensegric_fit::node {

/// Reads parameters by name; whatever is out of range, of another type, or left unread is refused by name.
/// Defaults are the fields of the stages' option structs.
class Parameters {
 public:
  /// A node's private parameters.
  explicit Parameters(const ros::NodeHandle& private_node);

  /// The same without a master: what a configuration file (launch/config) says of the stage of that name.
  /// `values` is a map, or nothing where all are defaults.
  Parameters(const YAML::Node& values, const std::string& stage);

  /// \throw Refusal bad_option naming parameter, value and range
  int integer(const std::string& name, int fallback, const geometry::Range& range);
  double number(const std::string& name, double fallback, const geometry::Range& range);
  bool flag(const std::string& name, bool fallback);
  std::string text(const std::string& name, const std::string& fallback);
  /// A tf frame. Where none is set, `fallback` within the node's own namespace ("left/body" for
  /// /left/landmarks): two booths on one master share none.
  std::string frame(const std::string& name, const std::string& fallback);
  std::string choice(const std::string& name, const std::string& fallback,
                     const std::vector<std::string>& words);
  Eigen::Vector3d vector(const std::string& name, const Eigen::Vector3d& fallback);
  /// A list; empty where it is not set.
  std::vector<std::string> texts(const std::string& name);

  /// Call when all are read. \throw Refusal bad_option naming a parameter that the node does not know
  void check_all_known() const;

 private:
  const XmlRpc::XmlRpcValue* find(const std::string& name);

  std::string prefix_;          // of full names
  XmlRpc::XmlRpcValue values_;  // a struct
  std::set<std::string> known_;
};

}  // namespace tensegric_fit::node
