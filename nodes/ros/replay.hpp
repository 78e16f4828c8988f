/// Sends scans and garments through a running chain and keeps what comes out.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/ScanLabel.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

class Replay {
 public:
  struct Options {
    double timeout = 120;       ///< seconds that the chain may take to come up, and a scan to go through
    bool measure_only = false;  ///< the chain ends at the landmarks
  };

  Replay(ros::NodeHandle node, const Options& options);

  /// Waits until the whole chain is there. Names the topics that nobody serves; empty: none.
  std::vector<std::string> wait_for_chain();

  /// Each writes what goes in and what comes out to `out`, at `time`, so that `out` can be replayed, too.
  /// False: it took too long, or was not understood; a refusal is an answer, and goes to /diagnostics in
  /// `out`.
  bool send(const sensor_msgs::PointCloud2& scan, const ros::Time& time, rosbag::Bag& out);
  /// To be worn from now on, and on the scan before, if it went through.
  bool send(const Garment& garment, const ros::Time& time, rosbag::Bag& out);
  /// Scans keep their ids, and labels their scans. Nothing answers.
  void send(const ScanLabel& label, const ros::Time& time, rosbag::Bag& out);

 private:
  struct Answer : FittedScan {
    BodyModel::ConstPtr model;
    FitWarnings::ConstPtr said;  ///< of the fit: `warnings` as they travel
  };
  template <typename Message>
  void keep(const std::string& topic, boost::shared_ptr<const Message> Answer::*slot);
  void on_tf(const tf2_msgs::TFMessage::ConstPtr& message);
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message);
  bool wait(const std::function<bool()>& condition) const { return wait(condition, options_.timeout); }
  bool wait(const std::function<bool()>& condition, double seconds) const;
  bool answered() const;
  void write_input(const Garment& garment, const ros::Time& time, rosbag::Bag& out) const;
  void write_answer(const ros::Time& time, rosbag::Bag& out, bool whole);

  const Options options_;
  ros::NodeHandle node_;
  ros::Publisher scans_, labels_;
  ros::ServiceClient set_garment_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Subscriber diagnostics_in_, body_frame_in_, worn_in_;

  std::string scan_id_, last_stage_;
  ros::Time scan_stamp_;
  Answer got_;
  tf2_msgs::TFMessage::ConstPtr body_frame_;
  Garment::ConstPtr worn_;  // as the chain says
  bool refused_ = false;
  bool went_through_ = false;  // the scan that is at hand: a garment is fitted to it
  std::map<std::string, diagnostic_msgs::DiagnosticArray::ConstPtr> diagnostics_;  // newest of each stage
};

}  // namespace tensegric_fit::node
