/// Which figures of a body a booth's sensors cannot see.
#pragma once

#include <string>
#include <vector>

#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Names as in virtual_body::Doubts, of bust points, crotch, axillae and shoulders, and of the heights that
/// are read off points: those that have a place from whose neighbourhood no ray returns, as far round as ISO
/// 20685 allows the figure to be off (heights 4 mm, bust points 5, other points 10).
std::vector<std::string> hidden_figures(const virtual_body::VirtualBody& body, const ScannerOptions& options);

/// The body's own doubts, and what this booth cannot see.
virtual_body::Doubts doubts_in_booth(const virtual_body::VirtualBody& body, const ScannerOptions& options);

}  // namespace tensegric_fit::virtual_booth
