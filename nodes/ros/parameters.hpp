/// A node's private parameters, each checked.
#pragma once

#include <ros/node_handle.h>

#include <Eigen/Core>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace tensegric_fit::node {

/// Reads parameters by name; whatever is out of range, of another type, or left unread is refused by name.
/// Defaults are the fields of the stages' option structs.
class Parameters {
 public:
  explicit Parameters(const ros::NodeHandle& private_node);

  /// \throw Refusal bad_option naming parameter, value and range
  int integer(const std::string& name, int fallback, int low, int high);
  double number(const std::string& name, double fallback, double low, double high);
  bool flag(const std::string& name, bool fallback);
  std::string text(const std::string& name, const std::string& fallback);
  std::string choice(const std::string& name, const std::string& fallback,
                     const std::vector<std::string>& words);
  Eigen::Vector3d vector(const std::string& name, const Eigen::Vector3d& fallback);
  /// A list; empty where it is not set.
  std::vector<std::string> texts(const std::string& name);

  /// Call when all are read. \throw Refusal bad_option naming a parameter that the node does not know
  void check_all_known() const;

 private:
  template <typename T>
  T read(const std::string& name, const T& fallback, const char* type);

  ros::NodeHandle node_;
  std::set<std::string> known_;
};

}  // namespace tensegric_fit::node
