#include "scan_files/customer_name.hpp"

#include <filesystem>

#include "geometry/status.hpp"

namespace tensegric_fit::scan_files {

std::regex customer_pattern(const std::string& text) {
  try {
    std::regex pattern(text);
    if (text.empty() || pattern.mark_count() == 1) return pattern;
  } catch (const std::regex_error&) {
  }
  throw geometry::Refusal(
      geometry::refusal::kBadOption,
      "parameter 'customer_pattern': '" + text + "' is no regular expression with one group (...)");
}

std::string customer_in(const std::string& path, const std::regex& pattern) {
  const std::string name = std::filesystem::path(path).filename();
  std::smatch match;
  return pattern.mark_count() == 1 && std::regex_search(name, match, pattern) ? match[1].str() : "";
}

}  // namespace tensegric_fit::scan_files
