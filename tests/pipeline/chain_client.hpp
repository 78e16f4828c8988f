/// A client of the launched chain: sends scans and hears everything that comes out.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/TriangleMesh.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tensegric_fit::tests {

/// Seconds that a coarse scan may take; a stuck chain must not hold the tests up.
inline constexpr double kPatience = 60;

/// Waits until `condition` holds, with callbacks served. False: it did not within `seconds`.
bool wait_for(const std::function<bool()>& condition, double seconds = kPatience);

/// Serves callbacks for that long, to hear what should not come.
void listen(double seconds);

/// The scan of virtual body "a" or "b", with a stamp of its own.
sensor_msgs::PointCloud2 booth_scan(const std::string& body);

class ChainClient {
 public:
  ChainClient();

  /// Waits until the chain is there and listens.
  bool ready();

  /// Returns the scan_id that the chain must give it.
  std::string send(const sensor_msgs::PointCloud2& scan);

  /// Sends it and waits for the deformed body. Returns the scan_id, or "" where none came.
  std::string fit(const sensor_msgs::PointCloud2& scan);

  /// What came, in order. Of the states of a fit only the last ones, not those on the way.
  std::vector<BodyModel::ConstPtr> models;
  std::vector<TriangleMesh::ConstPtr> bodies;
  std::vector<Landmarks::ConstPtr> landmarks;
  std::vector<ControlMesh::ConstPtr> controls;
  std::vector<FitState::ConstPtr> fits;
  std::vector<LineForces::ConstPtr> forces;
  std::vector<DeformedMesh::ConstPtr> deformed;

  /// Newest words of each stage on /diagnostics, by stage and key.
  std::map<std::string, std::map<std::string, std::string>> diagnostics;

  /// The name under which any stage refused that scan; "" where none did.
  std::string refusal_of(const std::string& scan_id) const;

  void forget();

 private:
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message);

  ros::NodeHandle node_;
  ros::Publisher scans_;
  std::vector<ros::Subscriber> subscribers_;
};

/// How many of the messages belong to that scan.
template <typename Messages>
int count_of(const Messages& messages, const std::string& scan_id) {
  int count = 0;
  for (const auto& message : messages) count += message->scan_id == scan_id;
  return count;
}

}  // namespace tensegric_fit::tests
