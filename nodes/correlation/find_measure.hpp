/// Girths and heights by their names.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::correlation {

/// Null where it was not found.
inline const geometry::Measure* find_measure(const std::vector<geometry::Measure>& measures,
                                             const std::string& name) {
  const auto found = std::find_if(measures.begin(), measures.end(),
                                  [&name](const geometry::Measure& m) { return m.name == name; });
  return found == measures.end() ? nullptr : &*found;
}

}  // namespace tensegric_fit::correlation
