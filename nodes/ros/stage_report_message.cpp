#include "ros/stage_report_message.hpp"

#include <cmath>
#include <cstdlib>

#include "ros/status_fact.hpp"

namespace tensegric_fit::node {
namespace {

constexpr char kUnnamed[] = "internal_error";  // as a stage calls what nobody foresaw

}  // namespace

std::optional<geometry::StageReport> stage_report_in(const diagnostic_msgs::DiagnosticStatus& status,
                                                     const std::string& name_space) {
  // "left/reconstruction: reconstruction"
  const std::size_t colon = status.name.find(": ");
  if (colon == std::string::npos || fact(status, "state").empty()) return std::nullopt;
  const std::string node = "/" + status.name.substr(0, colon);
  const std::size_t slash = node.rfind('/');
  if ((slash == 0 ? "/" : node.substr(0, slash)) != name_space) return std::nullopt;

  geometry::StageReport report;
  report.stage = status.name.substr(colon + 2);
  report.state = fact(status, "state");
  report.message = status.message;
  // the assembler knows a capture by its stamp until it is a scan
  const std::string made = fact(status, "scan");
  report.scan_id = report.state == "done" && !made.empty() ? made : fact(status, "scan_id");
  report.warns = report.state == "done" && status.level == diagnostic_msgs::DiagnosticStatus::WARN;
  report.last_error = fact(status, "last_error_message");
  report.code = fact(status, "last_error");
  if (report.refused() && report.code.empty()) report.code = kUnnamed;  // not one of our stages
  const double working = std::strtod(fact(status, "working_seconds").c_str(), nullptr);
  if (std::isfinite(working) && working > 0) report.working_seconds = working;
  return report;
}

}  // namespace tensegric_fit::node
