/// A bag through the launched chain.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "recording.hpp"

namespace tensegric_fit::regression {

/// What goes into a replay, and where its files go: config.yaml, bags and logs.
struct ReplayInput {
  std::string bag;
  YAML::Node pipeline;  ///< parameters by stage
  bool measure_only = false;
  std::string folder;
};

/// Launches launch/replay.launch, or for a bag of a booth's sensors assemble.launch, under a master of its
/// own, on a free port, and waits for its end; a stuck launch is ended after two minutes. What went wrong, in
/// a sentence; empty: nothing. Opens no bag itself: rosbag's are for one thread.
std::string launch_replay(const ReplayInput& input);
std::string launch_assembly(const ReplayInput& input);

/// What came out of them. Nothing where nothing was written.
Recording replayed(const ReplayInput& input, const std::string& scan_id);
sensor_msgs::PointCloud2::ConstPtr assembled(const ReplayInput& input);

}  // namespace tensegric_fit::regression
