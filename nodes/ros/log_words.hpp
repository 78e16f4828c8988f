/// What may stand in a log.
#pragma once

#include <string>

namespace tensegric_fit::node {

/// The sentence with # in place of each number: logs outlive the customer's visit, and hold no measure of
/// her. Digits within a name (B1) stay.
std::string without_figures(const std::string& sentence);

}  // namespace tensegric_fit::node
