/// What a booth and its chain publish -> feedback and result of the action `capture`
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <sensor_msgs/PointCloud2.h>
#include <tensegric_fit/CaptureFeedback.h>
#include <tensegric_fit/CaptureGoal.h>
#include <tensegric_fit/CaptureResult.h>
#include <tensegric_fit/DeformedMesh.h>

#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "capture/capture_watch.hpp"
#include "capture/heard_sensors.hpp"
#include "geometry/slop.hpp"
#include "ros/parameters.hpp"

namespace tensegric_fit::node {

/// One goal at a time. Times are seconds of any steady clock. For one thread.
class CaptureHandler {
 public:
  /// `name_space`: of the booth. `slop`: of the assembler that it follows, s, where its own parameter is not
  /// set. \throw Refusal bad_option
  CaptureHandler(Parameters parameters, std::string name_space, double slop = geometry::kUsualSlop);

  /// Service that makes the booth scan; empty where it scans by itself.
  const std::string& trigger() const { return setup_.trigger; }

  /// Replaces the current goal. Where there is a trigger, no scan counts until it was pulled.
  /// \throw Refusal bad_option: a timeout out of range
  void begin(const CaptureGoal& goal, double now);
  void stop();
  bool is_busy() const { return watch_ != nullptr; }

  double begun() const { return begun_; }
  bool waits_for_trigger() const { return is_busy() && !armed_; }
  /// Whether a call of the trigger, of this goal or an earlier one, is still without its answer.
  void set_unanswered(bool unanswered) { unanswered_ = unanswered; }
  /// A scan with an older stamp (ns) is another customer's.
  void pulled(std::uint64_t stamp);

  /// What it holds of that scan; whether the goal is of it, and to be ended.
  bool forget(const std::string& scan_id);

  /// `now`: when it came; just before the next goal where it is left out.
  void add(const std::string& sensor, const sensor_msgs::PointCloud2& cloud,
           double now = std::numeric_limits<double>::infinity());
  void add(const sensor_msgs::PointCloud2& scan);
  void add(const Landmarks::ConstPtr& landmarks);
  void add(const DeformedMesh& deformed);
  void add(const diagnostic_msgs::DiagnosticArray& message, double now);

  // \pre is_busy()

  const std::string& scan_id() const { return watch_->scan_id(); }  ///< empty until the scan has come
  CaptureFeedback feedback(double now);
  /// Nothing while the goal is under way; it ends with its result.
  std::optional<CaptureResult> result(double now);
  /// It ends here.
  CaptureResult refused(const std::string& code, const std::string& message);

 private:
  struct Setup {
    double timeout = 60, slop = geometry::kUsualSlop;  ///< s
    std::string trigger;
  };
  static Setup setup_from(Parameters& parameters, double slop);
  void watch(std::uint64_t not_before);

  const Setup setup_;
  const std::string name_space_;
  capture::StageBoard board_;
  capture::HeardSensors heard_;
  std::deque<std::string> seen_;  // scans

  // of the current goal
  CaptureGoal goal_;
  double begun_ = 0;
  bool armed_ = false;  // the trigger was pulled, or there is none
  bool unanswered_ = false;
  std::unique_ptr<capture::CaptureWatch> watch_;          // null: no goal
  std::map<std::string, Landmarks::ConstPtr> landmarks_;  // by scan
  std::map<std::string, std::string> fit_status_;         // by scan
};

}  // namespace tensegric_fit::node
