/// What values an option may have, declared once: for the core's check and for the node's.
#pragma once

#include <string>

namespace tensegric_fit::geometry {

/// From `low` to `high`, both included; in the option's unit.
struct Range {
  double low, high;

  /// False for NaN.
  bool holds(double value) const { return value >= low && value <= high; }
};

/// \throw Refusal bad_option naming option, value and range
void check_option(const std::string& name, double value, const Range& range);

}  // namespace tensegric_fit::geometry
