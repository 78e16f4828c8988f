#include "capture/capture_handler.hpp"

#include <fmt/format.h>

#include <tensegric_fit/FitState.h>

#include <ros/names.h>

#include <algorithm>

#include "geometry/range.hpp"
#include "geometry/status.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage_report_message.hpp"

namespace tensegric_fit::node {
namespace {

constexpr std::size_t kRemembered = 64;     // scans
constexpr std::size_t kMostSensors = 64;    // as of the assembler
const geometry::Range kTimeout{0.1, 3600};  // s

}  // namespace

CaptureHandler::Setup CaptureHandler::setup_from(Parameters& parameters, double slop) {
  Setup setup;
  setup.slop = slop;
  setup.timeout = parameters.number("timeout", setup.timeout, kTimeout);
  setup.slop = parameters.number("slop", setup.slop, geometry::kSlop);
  setup.trigger = parameters.text("trigger", setup.trigger);
  std::string error;
  if (!setup.trigger.empty() && (setup.trigger.front() == '~' || setup.trigger.back() == '/'))
    error = "'" + setup.trigger + "' is no name of a service";
  if (!error.empty() || !ros::names::validate(setup.trigger, error))
    throw geometry::Refusal(geometry::refusal::kBadOption, "parameter 'trigger': " + error);
  parameters.check_all_known();
  return setup;
}

CaptureHandler::CaptureHandler(Parameters parameters, std::string name_space, double slop)
    : setup_(setup_from(parameters, slop)), name_space_(std::move(name_space)) {}

void CaptureHandler::begin(const CaptureGoal& goal, double now) {
  landmarks_.clear();
  fit_status_.clear();
  if (goal.timeout != 0) geometry::check_option("timeout", goal.timeout, kTimeout);
  if (goal.sensors.size() > kMostSensors)
    throw geometry::Refusal(
        geometry::refusal::kBadOption,
        fmt::format("'sensors' has {} topics, more than {}", goal.sensors.size(), kMostSensors));
  goal_ = goal;
  begun_ = now;
  armed_ = setup_.trigger.empty();
  watch(armed_ ? 0 : capture::kNever);
  if (armed_)
    heard_.follow(goal_.sensors, now, *watch_);  // what came before a trigger was pulled is another's
}

void CaptureHandler::stop() {
  watch_.reset();
  landmarks_.clear();
  fit_status_.clear();
}

bool CaptureHandler::forget(const std::string& scan_id) {
  landmarks_.erase(scan_id);
  fit_status_.erase(scan_id);
  return is_busy() && watch_->scan_id() == scan_id;
}

void CaptureHandler::pulled(std::uint64_t stamp) {
  armed_ = true;
  watch(stamp);
}

void CaptureHandler::watch(std::uint64_t not_before) {
  const double timeout = goal_.timeout > 0 ? goal_.timeout : setup_.timeout;
  watch_ = std::make_unique<capture::CaptureWatch>(
      capture::CaptureGoal{goal_.sensors, timeout, static_cast<bool>(goal_.with_fit), not_before}, board_,
      setup_.slop, begun_);
}

void CaptureHandler::add(const std::string& sensor, const sensor_msgs::PointCloud2& cloud, double now) {
  const std::uint64_t stamp = cloud.header.stamp.toNSec();
  heard_.add(sensor, stamp, now);
  if (watch_) watch_->add_cloud(sensor, stamp);
}

void CaptureHandler::add(const sensor_msgs::PointCloud2& scan) {
  const std::string scan_id = tag_of(scan).scan_id;
  if (std::find(seen_.begin(), seen_.end(), scan_id) != seen_.end())
    return;  // a node sends its last one again
  seen_.push_back(scan_id);
  if (seen_.size() > kRemembered) seen_.pop_front();
  if (!watch_) return;
  watch_->add_scan(scan_id, scan.header.stamp.toNSec());
  if (watch_->scan_id().empty()) return;
  for (auto it = landmarks_.begin(); it != landmarks_.end();)
    it = it->first == watch_->scan_id() ? std::next(it) : landmarks_.erase(it);
}

void CaptureHandler::add(const Landmarks::ConstPtr& landmarks) {
  if (!watch_ || (!watch_->scan_id().empty() && watch_->scan_id() != landmarks->scan_id)) return;
  landmarks_[landmarks->scan_id] = landmarks;  // they may overtake their scan
  if (landmarks_.size() > kRemembered) landmarks_.erase(landmarks_.begin());
  watch_->add_landmarks(landmarks->scan_id);
}

void CaptureHandler::add(const DeformedMesh& deformed) {
  if (!watch_ || !goal_.with_fit || deformed.status == FitState::SOLVING) return;
  fit_status_[deformed.scan_id] = deformed.status;
  watch_->add_fit(deformed.scan_id);
}

void CaptureHandler::add(const diagnostic_msgs::DiagnosticArray& message, double now) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    const auto report = stage_report_in(status, name_space_);
    if (report && board_.report(*report, now) && watch_ && armed_) watch_->add_refusal(*report);
  }
}

CaptureFeedback CaptureHandler::feedback(double now) {
  const capture::CaptureProgress progress = watch_->progress(now);
  CaptureFeedback feedback;
  feedback.stage = progress.stage;
  feedback.progress = progress.share;
  feedback.message = progress.message;
  feedback.scan_id = watch_->scan_id();
  feedback.missing = progress.missing;
  return feedback;
}

std::optional<CaptureResult> CaptureHandler::result(double now) {
  const auto end = watch_->end(now);
  if (!end) return std::nullopt;
  const bool waits =
      end->code == geometry::refusal::kTimedOut || end->code == geometry::refusal::kMissingSensor;
  if (waits && unanswered_ && scan_id().empty())
    return refused(geometry::refusal::kTriggerFailed, setup_.trigger + " has not answered; " + end->message);
  if (!end->code.empty()) return refused(end->code, end->message);
  CaptureResult result;
  result.measured = true;
  result.message = end->message;
  result.scan_id = watch_->scan_id();
  const auto landmarks = landmarks_.find(result.scan_id);
  if (landmarks == landmarks_.end()) return std::nullopt;  // forgotten
  result.landmarks = *landmarks->second;
  if (goal_.with_fit) result.fit_status = fit_status_[result.scan_id];
  stop();
  return result;
}

CaptureResult CaptureHandler::refused(const std::string& code, const std::string& message) {
  CaptureResult result;
  result.code = code;
  result.message = message;
  result.scan_id = watch_->scan_id();
  stop();
  return result;
}

}  // namespace tensegric_fit::node
