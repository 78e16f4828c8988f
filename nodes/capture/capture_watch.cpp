#include "capture/capture_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/scan_stamp.hpp"
#include "geometry/slop.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::capture {
namespace {

/// The chain, in its order: how much of the whole is over when a stage begins, and what it takes on two
/// cores, s.
struct Step {
  const char* stage;
  double begin, seconds;
};
constexpr Step kSensors{"sensors", 0, 0}, kAssembler{"assembler", 0.1, 1};
constexpr Step kChain[] = {{"reconstruction", 0.25, 3},
                           {"landmarks", 0.75, 0.5},
                           {"control_mesh", 0.85, 0.5},
                           {"tensegric", 0.9, 0.1},
                           {"tffd", 0.95, 0.2}};
constexpr int kMeasuring = 2, kAll = 5;  // stages of the chain
constexpr int kInFlight = 2;  // clouds of a sensor that were on their way when a scan was asked for
constexpr const char* kBehindAScan[] = {"correlation"};  // other stages that work on one

}  // namespace

CaptureWatch::CaptureWatch(CaptureGoal goal, const StageBoard& board, double slop, double now)
    : goal_(std::move(goal)),
      board_(board),
      slop_(static_cast<std::uint64_t>(std::llround(1e9 * slop))),
      start_(now) {}

bool CaptureWatch::is_early(std::uint64_t stamp) const {
  return stamp < goal_.not_before && (stamp != 0 || goal_.not_before == kNever);
}

void CaptureWatch::note_early(std::uint64_t stamp, int count) {
  if (goal_.not_before == kNever) return;
  early_ = std::max(early_, stamp);
  early_count_ += count;
}

void CaptureWatch::add_cloud(const std::string& sensor, std::uint64_t stamp) {
  if (is_early(stamp)) return note_early(stamp, 1);
  clouds_[sensor].push_back(stamp);
}

void CaptureWatch::add_earlier_cloud(const std::string& sensor, std::uint64_t stamp) {
  if (stamp != 0) earlier_clouds_[sensor].push_back(stamp);  // without a stamp it is of any scan, or none
}

void CaptureWatch::add_scan(const std::string& scan_id, std::uint64_t stamp) {
  if (is_early(stamp)) return note_early(stamp, kInFlight + 1);
  if (scan_id == scan_id_ || refused_) return;
  if (!scan_id_.empty()) {
    if (!is_complete())
      refused_ = CaptureEnd{geometry::refusal::kSuperseded,
                            fmt::format("scan {} came before scan {} was through", scan_id, scan_id_)};
    return;
  }
  scan_id_ = scan_id;
  stamp_ = stamp;
}

void CaptureWatch::add_refusal(const StageReport& report) {
  const bool is_behind =
      std::any_of(std::begin(kChain), std::end(kChain),
                  [&](const Step& step) { return report.stage == step.stage; }) ||
      std::find(std::begin(kBehindAScan), std::end(kBehindAScan), report.stage) != std::end(kBehindAScan);
  if (is_behind || !scan_id_.empty() || refused_) return;
  const auto stamp = geometry::stamp_in(report.scan_id);
  if (stamp && is_early(*stamp)) return note_early(*stamp, kInFlight + 1);
  refused_ = CaptureEnd{report.code, report.last_error};
}

/// Earlier clouds count for their scan alone: before it came, they may be the customer's before.
bool CaptureWatch::was_heard(const std::string& sensor) const {
  if (scan_id_.empty()) return clouds_.count(sensor) != 0;
  for (const auto* of_sensors : {&clouds_, &earlier_clouds_}) {
    const auto clouds = of_sensors->find(sensor);
    if (clouds != of_sensors->end() &&
        std::any_of(clouds->second.begin(), clouds->second.end(),
                    [this](std::uint64_t stamp) { return geometry::gap(stamp, stamp_) <= slop_; }))
      return true;
  }
  return false;
}

std::vector<std::string> CaptureWatch::missing() const {
  std::vector<std::string> names;
  for (const std::string& sensor : goal_.sensors)
    if (!was_heard(sensor)) names.push_back(sensor);
  return names;
}

bool CaptureWatch::is_complete() const {
  return measured_.count(scan_id_) != 0 && (!goal_.with_fit || fitted_.count(scan_id_) != 0);
}

std::string CaptureWatch::stage() const {
  if (scan_id_.empty()) return missing().empty() && !clouds_.empty() ? kAssembler.stage : kSensors.stage;
  const int last = (goal_.with_fit ? kAll : kMeasuring) - 1;
  for (int i = 0; i < last; ++i) {
    const StageReport* report = board_.find(kChain[i].stage);
    if (report == nullptr || report->scan_id != scan_id_ || report->state != "done") return kChain[i].stage;
  }
  return kChain[last].stage;
}

std::string CaptureWatch::waiting_for(double now) const {
  const std::vector<std::string> names = missing();
  std::string words;
  if (!names.empty())
    words = fmt::format("waiting for {}", fmt::join(names, ", "));
  else if (scan_id_.empty())
    words = "waiting for a scan on scan/points";
  else
    words = fmt::format("scan {}: waiting for {}{}", scan_id_, stage(),
                        board_.find(stage()) == nullptr ? ", which never reported: is it running?" : "");
  if (scan_id_.empty() && clouds_.empty() && early_count_ > kInFlight)
    words += fmt::format(
        ", and what came was stamped {:.1f} s and more before it was asked for: are the clocks of scanner "
        "and capture alike?",
        1e-9 * static_cast<double>(goal_.not_before - early_));
  const std::string trouble = board_.trouble(now);
  return trouble.empty() ? words : words + " (" + trouble + ")";
}

CaptureProgress CaptureWatch::progress(double now) {
  const std::string at = stage();
  Step step = at == kSensors.stage ? kSensors : kAssembler;
  double end = at == kSensors.stage ? kAssembler.begin : kChain[0].begin;
  for (int i = 0; i < kAll; ++i) {
    if (at != kChain[i].stage) continue;
    step = kChain[i];
    end = i + 1 < kAll ? kChain[i + 1].begin : 1;
  }
  double within = 0;  // share of the step
  if (step.seconds > 0)
    within = 1 - std::exp(-board_.working_seconds(at, now) / step.seconds);
  else if (!goal_.sensors.empty())
    within = 1 - static_cast<double>(missing().size()) / static_cast<double>(goal_.sensors.size());
  const double all = goal_.with_fit ? 1 : kChain[kMeasuring].begin;
  const double share = is_complete() ? 1 : std::min(1.0, (step.begin + within * (end - step.begin)) / all);
  share_ = std::max(share_, share);
  return {at, share_, waiting_for(now), missing()};
}

std::string CaptureWatch::warnings() const {
  std::string words;
  for (const char* name : {"assembler", "reconstruction", "landmarks", "control_mesh"}) {
    const StageReport* report = board_.find(name);
    if (report != nullptr && report->scan_id == scan_id_ && report->warns)
      words += (words.empty() ? "" : "; ") + report->message;
  }
  return words;
}

// A stage that has yet to work for this capture, and will not. Nothing else would end the wait but the
// timeout.
std::optional<CaptureEnd> CaptureWatch::dead_stage(double now) const {
  std::vector<std::string> needed;
  if (scan_id_.empty() && board_.find(kAssembler.stage) != nullptr) needed.push_back(kAssembler.stage);
  for (int i = 0; i < (goal_.with_fit ? kAll : kMeasuring); ++i) {
    const StageReport* report = board_.find(kChain[i].stage);
    const bool is_over =
        !scan_id_.empty() && report != nullptr && report->scan_id == scan_id_ && report->state == "done";
    if (!is_over) needed.push_back(kChain[i].stage);
  }
  for (const std::string& stage : needed) {
    const double silent = board_.silent_seconds(stage, start_, now);
    if (silent > StageBoard::kGone)
      return CaptureEnd{
          geometry::refusal::kDeadStage,
          fmt::format("{} {}: start it, then capture again", stage,
                      board_.find(stage) == nullptr ? "is not running"
                                                    : fmt::format("is dead: silent for {:.0f} s", silent))};
  }
  return std::nullopt;
}

std::optional<CaptureEnd> CaptureWatch::end(double now) const {
  if (refused_) return refused_;
  if (!scan_id_.empty()) {
    for (int i = 0; i < (goal_.with_fit ? kAll : kMeasuring); ++i) {
      const StageReport* report = board_.find(kChain[i].stage);
      if (report != nullptr && report->refused() && report->scan_id == scan_id_)
        return CaptureEnd{report->code, report->last_error};
    }
    if (is_complete() && missing().empty()) return CaptureEnd{"", warnings()};
    if (is_complete())
      return CaptureEnd{geometry::refusal::kMissingSensor,
                        fmt::format("scan {} is without {}", scan_id_, fmt::join(missing(), ", "))};
  }
  if (const std::optional<CaptureEnd> dead = dead_stage(now)) return dead;
  if (now - start_ < goal_.timeout) return std::nullopt;
  return CaptureEnd{missing().empty() ? geometry::refusal::kTimedOut : geometry::refusal::kMissingSensor,
                    fmt::format("{:g} s were not enough: {}", goal_.timeout, waiting_for(now))};
}

}  // namespace tensegric_fit::capture
