/// truth.json: what is known about a virtual body, to score measurements against.
#pragma once

#include <string>

#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Landmarks in the scan's frame; heights along body z; metres. \throw std::runtime_error where it cannot be
/// written
void write_truth(const std::string& path, const virtual_body::VirtualBody& body,
                 const ScannerOptions& scanner);

}  // namespace tensegric_fit::virtual_booth
