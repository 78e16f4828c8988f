/// Order statistics.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace tensegric_fit::geometry {

/// The value below which that fraction (0 to 1) of the values lies. \pre not empty
inline double percentile(std::vector<double> values, double fraction) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Of an even number of values the upper one of the two in the middle. \pre not empty
template <typename Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The standard deviation of a Gaussian whose distances from its middle have this median: 1 / its 0.75
/// quantile (Rousseeuw and Croux 1993). \pre not empty
inline double robust_deviation(std::vector<double> distances) {
  return 1.4826 * median(std::move(distances));
}

}  // namespace tensegric_fit::geometry
