/// What a garment is warned of, as a message.
#pragma once

#include <tensegric_fit/FitWarnings.h>

#include <string>
#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/fit_warning.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {

/// Warnings and notices with their sentences.
FitWarnings to_message(const ScanTag& tag, const std::string& garment,
                       const std::vector<geometry::FitWarning>& warnings,
                       const geometry::BodyMeasures& measures);

}  // namespace tensegric_fit::node
