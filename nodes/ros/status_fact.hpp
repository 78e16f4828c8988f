/// What a stage said on /diagnostics, read again.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <string>

namespace tensegric_fit::node {

/// What a status says under that key; empty where it does not.
inline std::string fact(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& pair : status.values)
    if (pair.key == key) return pair.value;
  return "";
}

}  // namespace tensegric_fit::node
