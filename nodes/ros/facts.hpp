/// What a stage has to say of its work, on /diagnostics.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tensegric_fit::node {

/// Key and value, in the order in which they are shown.
using Facts = std::vector<std::pair<std::string, std::string>>;

}  // namespace tensegric_fit::node
