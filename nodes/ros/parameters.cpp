#include "ros/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

using XmlRpc::XmlRpcValue;

[[noreturn]] void refuse(const std::string& message) {
  throw geometry::Refusal(geometry::refusal::kBadOption, message);
}

// As rosparam reads it.
XmlRpcValue value_in(const YAML::Node& node) {
  if (node.IsSequence()) {
    XmlRpcValue list;
    list.setSize(static_cast<int>(node.size()));
    for (std::size_t i = 0; i < node.size(); ++i) list[static_cast<int>(i)] = value_in(node[i]);
    return list;
  }
  int whole = 0;
  double number = 0;
  bool flag = false;
  if (node.Tag() != "!") {  // a text in quotes is nothing but a text
    if (YAML::convert<int>::decode(node, whole)) return whole;
    if (YAML::convert<double>::decode(node, number)) return number;
    if (YAML::convert<bool>::decode(node, flag)) return flag;
  }
  return node.IsScalar() ? XmlRpcValue(node.Scalar()) : XmlRpcValue();
}

std::optional<double> number_in(const XmlRpcValue& value) {
  if (value.getType() == XmlRpcValue::TypeInt) return static_cast<const int&>(value);
  if (value.getType() == XmlRpcValue::TypeDouble) return static_cast<const double&>(value);
  return std::nullopt;
}

}  // namespace

Parameters::Parameters(const ros::NodeHandle& private_node) : prefix_(private_node.getNamespace() + "/") {
  private_node.getParam(private_node.getNamespace(), values_);
}

Parameters::Parameters(const YAML::Node& values, const std::string& stage) : prefix_("/" + stage + "/") {
  if (!values || values.IsNull()) return;
  if (!values.IsMap()) refuse(fmt::format("parameters of '{}' are not a map", stage));
  for (const auto& entry : values) values_[entry.first.Scalar()] = value_in(entry.second);
}

const XmlRpcValue* Parameters::find(const std::string& name) {
  known_.insert(name);
  return values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(name) ? &values_[name] : nullptr;
}

int Parameters::integer(const std::string& name, int fallback, const geometry::Range& range) {
  const XmlRpcValue* found = find(name);
  if (!found) return fallback;
  const std::optional<double> value = number_in(*found);
  if (!value || *value != std::floor(*value))
    refuse(fmt::format("parameter '{}{}' is not an integer", prefix_, name));
  if (!range.holds(*value))
    refuse(fmt::format("parameter '{}{}' is {:g}, not in [{}, {}]", prefix_, name, *value, range.low,
                       range.high));
  return static_cast<int>(*value);
}

double Parameters::number(const std::string& name, double fallback, const geometry::Range& range) {
  const XmlRpcValue* found = find(name);
  if (!found) return fallback;
  const std::optional<double> value = number_in(*found);
  if (!value) refuse(fmt::format("parameter '{}{}' is not a number", prefix_, name));
  if (!range.holds(*value))
    refuse(fmt::format("parameter '{}{}' is {:g}, not in [{}, {}]", prefix_, name, *value, range.low,
                       range.high));
  return *value;
}

bool Parameters::flag(const std::string& name, bool fallback) {
  const XmlRpcValue* found = find(name);
  if (!found) return fallback;
  if (found->getType() != XmlRpcValue::TypeBoolean)
    refuse(fmt::format("parameter '{}{}' is not true or false", prefix_, name));
  return static_cast<const bool&>(*found);
}

std::string Parameters::text(const std::string& name, const std::string& fallback) {
  const XmlRpcValue* found = find(name);
  if (!found) return fallback;
  if (found->getType() != XmlRpcValue::TypeString)
    refuse(fmt::format("parameter '{}{}' is not a text", prefix_, name));
  return static_cast<const std::string&>(*found);
}

std::string Parameters::frame(const std::string& name, const std::string& fallback) {
  const std::string set = text(name, "");
  if (!set.empty() && set.front() == '/')
    refuse(fmt::format("parameter '{}{}' is '{}': tf takes no slash in front", prefix_, name, set));
  if (!set.empty()) return set;
  const std::size_t end = prefix_.rfind('/', prefix_.size() - 2);  // before the node's name
  return prefix_.substr(1, end) + fallback;
}

std::string Parameters::choice(const std::string& name, const std::string& fallback,
                               const std::vector<std::string>& words) {
  const std::string value = text(name, fallback);
  if (std::find(words.begin(), words.end(), value) == words.end())
    refuse(fmt::format("parameter '{}{}' is '{}', not one of: {}", prefix_, name, value,
                       fmt::join(words, ", ")));
  return value;
}

Eigen::Vector3d Parameters::vector(const std::string& name, const Eigen::Vector3d& fallback) {
  const XmlRpcValue* found = find(name);
  if (!found) return fallback;
  Eigen::Vector3d value = Eigen::Vector3d::Constant(NAN);
  if (found->getType() == XmlRpcValue::TypeArray && found->size() == 3)
    for (int axis = 0; axis < 3; ++axis) value[axis] = number_in((*found)[axis]).value_or(NAN);
  if (!value.allFinite())
    refuse(fmt::format("parameter '{}{}' is not a list of three numbers", prefix_, name));
  return value;
}

std::vector<std::string> Parameters::texts(const std::string& name) {
  const XmlRpcValue* found = find(name);
  if (!found) return {};
  const auto wrong = [&] { refuse(fmt::format("parameter '{}{}' is not a list of texts", prefix_, name)); };
  if (found->getType() != XmlRpcValue::TypeArray) wrong();
  std::vector<std::string> values;
  for (int i = 0; i < found->size(); ++i) {
    if ((*found)[i].getType() != XmlRpcValue::TypeString) wrong();
    values.push_back(static_cast<const std::string&>((*found)[i]));
  }
  return values;
}

void Parameters::check_all_known() const {
  if (values_.getType() != XmlRpcValue::TypeStruct) return;
  for (auto entry = values_.begin(); entry != values_.end(); ++entry)
    if (known_.count(entry->first) == 0)
      refuse(fmt::format("parameter '{}{}' is unknown; the node knows: {}", prefix_, entry->first,
                         fmt::join(known_, ", ")));
}

}  // namespace tensegric_fit::node
