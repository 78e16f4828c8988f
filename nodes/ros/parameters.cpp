#include "ros/parameters.hpp"

#include <fmt/format.h>
#include <ros/param.h>

#include <algorithm>

#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw geometry::Refusal(geometry::refusal::kBadOption, message);
}

}  // namespace

Parameters::Parameters(const ros::NodeHandle& private_node) : node_(private_node) {}

template <typename T>
T Parameters::read(const std::string& name, const T& fallback, const char* type) {
  known_.insert(name);
  if (!node_.hasParam(name)) return fallback;
  T value;
  if (!node_.getParam(name, value))
    refuse(fmt::format("parameter '{}' is not {}", node_.resolveName(name), type));
  return value;
}

int Parameters::integer(const std::string& name, int fallback, int low, int high) {
  const int value = read(name, fallback, "an integer");
  if (value < low || value > high)
    refuse(fmt::format("parameter '{}' is {}, not in [{}, {}]", node_.resolveName(name), value, low, high));
  return value;
}

double Parameters::number(const std::string& name, double fallback, double low, double high) {
  const double value = read(name, fallback, "a number");
  if (!(value >= low && value <= high))
    refuse(fmt::format("parameter '{}' is {}, not in [{}, {}]", node_.resolveName(name), value, low, high));
  return value;
}

bool Parameters::flag(const std::string& name, bool fallback) {
  return read(name, fallback, "true or false");
}

std::string Parameters::text(const std::string& name, const std::string& fallback) {
  return read(name, fallback, "a text");
}

std::string Parameters::choice(const std::string& name, const std::string& fallback,
                               const std::vector<std::string>& words) {
  const std::string value = text(name, fallback);
  if (std::find(words.begin(), words.end(), value) == words.end())
    refuse(fmt::format("parameter '{}' is '{}', not one of: {}", node_.resolveName(name), value,
                       fmt::join(words, ", ")));
  return value;
}

Eigen::Vector3d Parameters::vector(const std::string& name, const Eigen::Vector3d& fallback) {
  const std::vector<double> value =
      read(name, std::vector<double>{fallback.x(), fallback.y(), fallback.z()}, "a list of numbers");
  if (value.size() != 3 || !Eigen::Vector3d(value[0], value[1], value[2]).allFinite())
    refuse(fmt::format("parameter '{}' is not a list of three numbers", node_.resolveName(name)));
  return {value[0], value[1], value[2]};
}

std::vector<std::string> Parameters::texts(const std::string& name) {
  return read(name, std::vector<std::string>(), "a list of texts");
}

void Parameters::check_all_known() const {
  std::vector<std::string> names;
  ros::param::getParamNames(names);
  std::sort(names.begin(), names.end());
  const std::string prefix = node_.getNamespace() + "/";
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) != 0 || known_.count(name.substr(prefix.size())) != 0)
      continue;
    refuse(fmt::format("parameter '{}' is unknown; the node knows: {}", name, fmt::join(known_, ", ")));
  }
}

}  // namespace tensegric_fit::node
