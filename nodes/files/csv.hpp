/// CSV files (RFC 4180).
#pragma once

#include <string>

namespace tensegric_fit::files {

/// A field, in quotes where it would read as more than one.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace tensegric_fit::files
