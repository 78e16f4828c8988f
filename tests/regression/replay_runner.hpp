/// A bag through the launched chain.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "recording.hpp"

namespace tensegric_fit::regression {

/// What a launch gave. `fault` is empty, or says in a sentence why nothing can be made of it.
struct Replayed {
  Recording recording;
  std::string fault;
};

/// Launches launch/replay.launch under a master of its own, on a free port, and waits for its end. Files go
/// to `folder`: config.yaml, replayed.bag, launch.log. A stuck launch is ended after two minutes.
Replayed replay(const std::string& bag, const std::string& scan_id, const YAML::Node& pipeline,
                bool measure_only, const std::string& folder);

}  // namespace tensegric_fit::regression
