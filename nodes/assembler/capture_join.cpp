#include "assembler/capture_join.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::assembler {
namespace {

constexpr std::size_t kMostOpen = 8;  // captures; beyond, the oldest waits no longer
constexpr std::uint64_t kStartedOver =
    60000000000u;  // ns; so far back lies no late cloud, but a new recording

}  // namespace

std::vector<int> Capture::missing() const {
  std::vector<int> result;
  for (std::size_t sensor = 0; sensor < clouds.size(); ++sensor)
    if (!clouds[sensor]) result.push_back(static_cast<int>(sensor));
  return result;
}

CaptureJoin::CaptureJoin(int sensors, const CaptureOptions& options)
    : sensors_(sensors), timeout_(options.timeout) {
  geometry::check_option("slop", options.slop, geometry::kSlop);
  geometry::check_option("timeout", options.timeout, kTimeout);
  slop_ = static_cast<std::uint64_t>(std::llround(1e9 * options.slop));
}

bool CaptureJoin::fits(const Capture& capture, std::uint64_t stamp) const {
  return std::max(capture.last, stamp) - std::min(capture.first, stamp) <= slop_;
}

CaptureJoin::Fate CaptureJoin::add(int sensor, std::shared_ptr<const SensorCloud> cloud, double now) {
  const std::uint64_t stamp = cloud->stamp;
  if (left_) {
    const auto& sent = left_->clouds[sensor];
    if (sent && sent->stamp == stamp) return Fate::played;
    if (open_.empty() && stamp + kStartedOver < left_->first)
      left_.reset();
    else if (stamp <= left_->last || (!sent && fits(*left_, stamp)))
      return Fate::late;
  }
  Open* nearest = nullptr;
  for (Open& open : open_) {
    const auto& sent = open.capture.clouds[sensor];
    if (sent && sent->stamp == stamp) return Fate::repeated;
    if (!sent && fits(open.capture, stamp) &&
        (!nearest || geometry::gap(stamp, open.capture.first) < geometry::gap(stamp, nearest->capture.first)))
      nearest = &open;
  }
  if (!nearest) {
    const auto later = std::find_if(open_.begin(), open_.end(),
                                    [stamp](const Open& open) { return open.capture.first > stamp; });
    Capture capture{stamp, stamp, {}};
    capture.clouds.resize(sensors_);
    nearest = &*open_.insert(later, {std::move(capture), now});
  }
  Capture& capture = nearest->capture;
  capture.first = std::min(capture.first, stamp);
  capture.last = std::max(capture.last, stamp);
  capture.clouds[sensor] = std::move(cloud);
  return Fate::taken;
}

std::optional<Capture> CaptureJoin::next(double now) {
  const bool due = open_.size() > kMostOpen || std::any_of(open_.begin(), open_.end(), [&](const Open& open) {
                     return now - open.since >= timeout_ || open.capture.missing().empty();
                   });
  if (!due) return std::nullopt;
  Capture capture = std::move(open_.front().capture);
  open_.erase(open_.begin());
  left_ = capture;
  for (auto& cloud : left_->clouds)  // a body's points are not kept
    if (cloud) cloud = std::make_shared<const SensorCloud>(SensorCloud{cloud->stamp, {}, {}});
  return capture;
}

}  // namespace tensegric_fit::assembler
