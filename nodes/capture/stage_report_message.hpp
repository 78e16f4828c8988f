/// What stages say on /diagnostics, for the board.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <optional>
#include <string>
#include <utility>

#include "capture/stage_board.hpp"

namespace tensegric_fit::node {

/// The stage's name and its report; nothing where the status is not of a stage whose node lies directly in
/// the namespace ("/", "/left").
std::optional<std::pair<std::string, capture::StageReport>> stage_report_in(
    const diagnostic_msgs::DiagnosticStatus& status, const std::string& name_space);

}  // namespace tensegric_fit::node
