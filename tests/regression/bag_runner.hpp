/// A bag through the stages' own handlers, without a master and without a clock.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "recording.hpp"

namespace tensegric_fit::regression {

/// Feeds scan/points and garment messages of a bag, in their order, into the handlers of all stages with the
/// parameters that `pipeline` has by stage; `measure_only`: into the first two alone. Where it has parameters
/// of an assembler, the clouds of its sensors are assembled first. Garments before the
/// scan are kept for it. A refusal ends what follows from that message and is recorded.
/// \pre the bag holds one scan. \throw Refusal: parameters; broken_file: no scan; rosbag::BagException
Recording run_bag(const std::string& bag, const YAML::Node& pipeline, bool measure_only);

}  // namespace tensegric_fit::regression
