/// The waist, and girths at given levels.
#pragma once

#include <string>

#include "landmarks/trunk.hpp"

namespace tensegric_fit::landmarks {

struct WaistLevel {
  double height;
  double confidence;
  std::string reason;
};

/// Level of the trunk's least tape girth inside (lowest, highest); where the girth has no inner minimum, the
/// level of the navel by proportion.
WaistLevel find_waist(const BodyShape& body, const Trunk& trunk, double lowest, double highest);

/// About the level of the navel, and of the waist ruler where a body has no waist.
double navel_height(const BodyShape& body);

}  // namespace tensegric_fit::landmarks
