/// The waist, and girths at given levels.
#pragma once

#include <functional>
#include <string>
#include <vector>

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

/// The tape at `height` where the scan did not see all its skin: that at `seen` below it, in the size that
/// the girths at `seen` and 20 mm below it lead to. `outline_at` cuts the trunk on a level (m). Empty where
/// there is no trunk.
std::vector<Eigen::Vector3d> tape_carried_up(const std::function<std::vector<Outline>(double)>& outline_at,
                                             double seen, double height);

/// About the level of the navel, and of the waist ruler where a body has no waist.
double navel_height(const BodyShape& body);

}  // namespace tensegric_fit::landmarks
