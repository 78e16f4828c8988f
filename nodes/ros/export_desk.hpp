/// The services export_fit and delete_export.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tensegric_fit/DeleteExport.h>
#include <tensegric_fit/ExportFit.h>
#include <tensegric_fit/ForgetOrder.h>

#include <mutex>

#include "ros/export_fit.hpp"
#include "ros/scan_labels.hpp"

namespace tensegric_fit::node {

/// Serves in a thread of its own: writing pictures and files holds nothing else up.
class ExportDesk {
 public:
  ExportDesk(const ros::NodeHandle& node, ExportOptions options);

  /// What is exported from now on.
  void keep(const FittedScan& scan);
  /// Exported with the fit that they belong to.
  void keep(const LineForces::ConstPtr& forces);
  /// Exported with its scan.
  void keep(const ScanLabel& label);

 private:
  FittedScan kept();
  bool on_export(ExportFit::Request& request, ExportFit::Response& response);
  bool on_delete(DeleteExport::Request& request, DeleteExport::Response& response);

  const ExportOptions options_;
  std::mutex mutex_;
  FittedScan fitted_;
  LineForces::ConstPtr forces_;
  ScanLabels labels_;
  ros::Subscriber orders_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> services_;
  ros::AsyncSpinner spinner_;  // last: it uses all of the above
};

}  // namespace tensegric_fit::node
