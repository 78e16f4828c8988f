/// How a fit went, as a drawing for the page.
#pragma once

#include <string>
#include <vector>

#include "tensegric/solver.hpp"

namespace tensegric_fit::regression {

/// SVG: by iteration the length of each line, % of rest, and how far the fit is from balance and from its
/// volumes, powers of ten (P2 Fig. 11). Empty for a fit of fewer than two iterations.
std::string history_plot(const std::vector<tensegric::Iterate>& history);

}  // namespace tensegric_fit::regression
