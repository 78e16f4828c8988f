#include "capture/stage_report_message.hpp"

#include <cstdlib>

#include "ros/status_fact.hpp"

namespace tensegric_fit::node {
namespace {

using diagnostic_msgs::DiagnosticStatus;

double number(const DiagnosticStatus& status, const std::string& key) {
  return std::strtod(fact(status, key).c_str(), nullptr);
}

}  // namespace

std::optional<std::pair<std::string, capture::StageReport>> stage_report_in(const DiagnosticStatus& status,
                                                                            const std::string& name_space) {
  // "left/reconstruction: reconstruction"
  const std::size_t colon = status.name.find(": ");
  if (colon == std::string::npos || fact(status, "state").empty()) return std::nullopt;
  const std::string node = "/" + status.name.substr(0, colon);
  const std::size_t slash = node.rfind('/');
  if ((slash == 0 ? "/" : node.substr(0, slash)) != name_space) return std::nullopt;

  capture::StageReport report;
  report.state = fact(status, "state");
  // the assembler knows a capture by its stamp until it is a scan
  const std::string made = fact(status, "scan");
  report.scan_id = report.state == "done" && !made.empty() ? made : fact(status, "scan_id");
  report.code = fact(status, "last_error");
  report.message = fact(status, "last_error_message");
  if (report.state == "done" && status.level == DiagnosticStatus::WARN) report.warning = status.message;
  report.working_seconds = number(status, "working_seconds");
  return std::pair{status.name.substr(colon + 2), report};
}

}  // namespace tensegric_fit::node
