/// What stages say on /diagnostics, read again.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <optional>
#include <string>

#include "geometry/stage_report.hpp"

namespace tensegric_fit::node {

/// Nothing where the status is not of a stage whose node lies directly in the namespace ("/", "/left").
std::optional<geometry::StageReport> stage_report_in(const diagnostic_msgs::DiagnosticStatus& status,
                                                     const std::string& name_space);

}  // namespace tensegric_fit::node
