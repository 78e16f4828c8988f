/// How near pulls are to the references': what page and panel show as a pull's uncertainty
/// (launch/tissue/newtons.yaml).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/calibration.hpp"

namespace tensegric_fit::calibration {

/// By case the pull over the reference's, geometric mean of its lines.
using PullRatios = std::vector<std::pair<std::string, double>>;

/// Of one case; nothing where its reference has no tensions or it did not converge.
std::optional<double> pull_ratio(const CalibrationCase& one, const CaseOutcome& outcome);

/// The file's text, `made` on that day. \throw Refusal too_few_data: no ratios; non_finite: one that gives no
/// half-width
std::string newtons_yaml(const PullRatios& ratios, int control_triangles, const std::string& made);

}  // namespace tensegric_fit::calibration
