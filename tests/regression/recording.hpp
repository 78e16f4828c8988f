/// What came out of a chain for one scan, however it was run.
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/TriangleMesh.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/status.hpp"
#include "tensegric/solver.hpp"

namespace tensegric_fit::regression {

/// What travels through the chain, in its order.
inline const std::string kChainTopics[] = {
    "scan/points",    "scan/label",    "garment",         "body/model",       "body/mesh",
    "body/landmarks", "/tf_static",    "control/mesh",    "control/deformed", "control/forces",
    "body/deformed",  "body/warnings", "worn/correlation"};

/// The name that the chain gives a topic of any namespace; empty: it is none of the chain's.
std::string chain_topic(const std::string& topic);

/// When a bag's first and last message were recorded. \throw rosbag::BagException
std::pair<ros::Time, ros::Time> times_of(const std::string& bag);

/// What `read` makes of a bag. \throw Refusal broken_file, as those of `read` but for Refusals: rosbag and
/// its streams throw many kinds
template <typename Read>
auto read_bag(const std::string& bag, const Read& read) {
  try {
    return read();
  } catch (const geometry::Refusal&) {
    throw;
  } catch (const std::exception& error) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile, bag + ": cannot be read: " + error.what());
  }
}

struct Recording {
  std::string scan_id;
  sensor_msgs::PointCloud2::ConstPtr scan;  ///< of several sensors; else null
  BodyModel::ConstPtr model;
  TriangleMesh::ConstPtr body;
  Landmarks::ConstPtr landmarks;
  tf2_msgs::TFMessage::ConstPtr body_frame;
  ControlMesh::ConstPtr control;
  // One per garment:
  std::vector<FitState::ConstPtr> fits;
  std::vector<LineForces::ConstPtr> forces;
  std::vector<DeformedMesh::ConstPtr> deformed;
  std::vector<FitWarnings::ConstPtr> warnings;
  std::vector<std::vector<tensegric::Iterate>> histories;  ///< one per garment; none of a replay
  std::string refused_by, refusal;                         ///< stage and code; empty: not refused
  /// By stage, of its last work on this scan.
  std::map<std::string, double> milliseconds, peak_mebibytes;
};

/// SHA-256 of what came on each topic, in hexadecimal digits: the messages as they travel, but for what is
/// not the chain's: header.seq, which the transport counts, and the time that a fit took.
std::map<std::string, std::string> hashes_of(const Recording& recording);

/// From a bag with what came out of a chain, what belongs to that scan; progress of fits is left out. \throw
/// rosbag::BagException
Recording recording_in(const std::string& bag, const std::string& scan_id);

/// Writes what came out behind what is in the bag, as the replay node does. \throw rosbag::BagException
void append(const Recording& recording, const std::string& bag);

}  // namespace tensegric_fit::regression
