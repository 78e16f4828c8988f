/// The panel's way to the pipeline.
#pragma once

#include <QObject>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#ifndef Q_MOC_RUN
#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <tensegric_fit/ControlMesh.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/FitWarnings.h>
#include <tensegric_fit/Garment.h>
#include <tensegric_fit/Landmarks.h>
#include <tensegric_fit/LineForces.h>
#include <tensegric_fit/ScanLabel.h>
#include <tensegric_fit/SetGarment.h>
#include <tensegric_fit/TriangleMesh.h>
#endif

namespace tensegric_fit::inspect {

/// Services are called in threads of their own, one for garments and one for exports, which may take long, so
/// that a pipeline that hangs never stops rviz: a call that
/// is on its way when the client goes is left alone. Of garments asked for while a call is on its way only
/// the newest is sent. Everything is reported in the thread that made the client.
class FitClient : public QObject {
  Q_OBJECT
 public:
  FitClient();
  ~FitClient() override;

  void wear(const SetGarment::Request& request);
  void reset();
  /// Of that scan's fit and no other's.
  void export_to(const std::string& folder, const std::string& scan_id);
  /// Whose the scan is.
  void label(const ScanLabel& label);
  /// A label of that scan is latched no longer.
  void forget_label(const std::string& scan_id);
  /// Whether a garment or a reset waits for its answer.
  bool is_asking();

  // What came; set before use.
  std::function<void(const Garment&)> on_garment;
  std::function<void(const FitState&)> on_fit;
  std::function<void(const LineForces&)> on_forces;
  std::function<void(const DeformedMesh&)> on_deformed;
  std::function<void(const FitWarnings&)> on_warnings;
  std::function<void(const TriangleMesh&)> on_body;
  std::function<void(const Landmarks&)> on_landmarks;
  std::function<void(const ControlMesh&)> on_control;
  std::function<void(const ScanLabel&)> on_label;
  std::function<void(const diagnostic_msgs::DiagnosticStatus&)> on_diagnostics;
  /// What the pipeline said to a call: whether it did it, and a sentence.
  std::function<void(bool done, const std::string&words)> on_worn, on_exported;

 private:
  struct Calls;
  using Call = std::function<void(Calls&)>;

  void post(const std::string& kind, Call call);
  template <typename Message>
  void listen(const char* topic, std::function<void(const Message&)> FitClient::*callback);

  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher labels_;
  std::string labelled_;  // the scan that a label is latched of
  const std::shared_ptr<Calls> calls_;
  std::map<std::string, std::thread> workers_;  // by kind of call
};

}  // namespace tensegric_fit::inspect
