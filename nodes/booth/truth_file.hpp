/// truth.json: what is known about a virtual body, to score measurements against.
#pragma once

#include <string>

#include "booth/virtual_body.hpp"
#include "booth/virtual_scanner.hpp"

namespace tensegric_fit::booth {

/// Landmarks in the scan's frame; heights along body z; metres. \throw std::runtime_error where it cannot be
/// written
void write_truth(const std::string& path, const VirtualBody& body, const ScannerOptions& scanner);

}  // namespace tensegric_fit::booth
