/// What became of all cases: for machines and for people.
#pragma once

#include <string>
#include <vector>

#include "harness.hpp"

namespace tensegric_fit::regression {

/// JUnit XML: a suite a runner, a test case a case.
std::string junit_xml(const std::vector<Outcome>& outcomes);

/// A line a metric of each run: case, runner, metric, found, expected, tolerance, error to the truth, holds;
/// what nothing is expected of has no expectation.
std::string json_lines(const std::vector<Outcome>& outcomes);

/// The top of a page that needs no network, with its title; `verdict` is markup.
std::string page_begin(const std::string& title, const std::string& verdict);

/// One page that needs no network: the verdict first, then each case with pictures and tables; it links
/// CASE.html beside it of each case that has a fit (fit_page).
std::string html_page(const std::vector<Outcome>& outcomes);

}  // namespace tensegric_fit::regression
