#include "capture/capture_handler.hpp"

#include <tensegric_fit/FitState.h>

#include <algorithm>
#include <limits>

#include "geometry/range.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage_report_message.hpp"

namespace tensegric_fit::node {
namespace {

constexpr std::size_t kRemembered = 64;     // scans
const geometry::Range kTimeout{0.1, 3600};  // s
constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

}  // namespace

CaptureHandler::Setup CaptureHandler::setup_from(Parameters& parameters) {
  Setup setup;
  setup.timeout = parameters.number("timeout", setup.timeout, kTimeout);
  setup.slop = parameters.number("slop", setup.slop, geometry::kSlop);
  setup.trigger = parameters.text("trigger", setup.trigger);
  parameters.check_all_known();
  return setup;
}

CaptureHandler::CaptureHandler(Parameters parameters, std::string name_space)
    : setup_(setup_from(parameters)), name_space_(std::move(name_space)) {}

void CaptureHandler::begin(const CaptureGoal& goal, double now) {
  if (goal.timeout != 0) geometry::check_option("timeout", goal.timeout, kTimeout);
  goal_ = goal;
  begun_ = now;
  landmarks_.clear();
  fit_status_.clear();
  armed_ = setup_.trigger.empty();
  watch(armed_ ? 0 : kNever);
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

void CaptureHandler::add(const std::string& sensor, const sensor_msgs::PointCloud2& cloud) {
  if (watch_) watch_->add_cloud(sensor, cloud.header.stamp.toNSec());
}

void CaptureHandler::add(const sensor_msgs::PointCloud2& scan) {
  const std::string scan_id = tag_of(scan).scan_id;
  if (std::find(seen_.begin(), seen_.end(), scan_id) != seen_.end())
    return;  // a node sends its last one again
  seen_.push_back(scan_id);
  if (seen_.size() > kRemembered) seen_.pop_front();
  if (watch_) watch_->add_scan(scan_id, scan.header.stamp.toNSec());
}

void CaptureHandler::add(const Landmarks::ConstPtr& landmarks) {
  if (!watch_) return;
  landmarks_[landmarks->scan_id] = landmarks;
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
  if (!end->code.empty()) return refused(end->code, end->message);
  CaptureResult result;
  result.measured = true;
  result.message = end->message;
  result.scan_id = watch_->scan_id();
  result.landmarks = *landmarks_.at(result.scan_id);
  if (goal_.with_fit) result.fit_status = fit_status_.at(result.scan_id);
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
