#include "assembler/capture_join.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

std::vector<int> Capture::blind() const {
  std::vector<int> result;
  for (std::size_t sensor = 0; sensor < clouds.size(); ++sensor)
    if (clouds[sensor] &&
        std::none_of(clouds[sensor]->cloud.points.begin(), clouds[sensor]->cloud.points.end(),
                     [](const Eigen::Vector3d& p) { return p.allFinite(); }))
      result.push_back(static_cast<int>(sensor));
  return result;
}

int Capture::seeing() const {
  return static_cast<int>(clouds.size() - missing().size() - blind().size());
}

std::string words_of(const OtherClock& clock, const std::vector<std::string>& topics) {
  std::vector<std::string> names;
  for (const int sensor : clock.sensors) names.push_back(topics[sensor]);
  return fmt::format("{} {} stamped {:.1f} s {} the others: are clocks set alike?", fmt::join(names, ", "),
                     names.size() == 1 ? "is" : "are", std::abs(clock.seconds),
                     clock.seconds < 0 ? "before" : "after");
}

CaptureJoin::CaptureJoin(int sensors, const CaptureOptions& options)
    : sensors_(sensors), min_sensors_(options.min_sensors), timeout_(options.timeout) {
  geometry::check_option("slop", options.slop, geometry::kSlop);
  geometry::check_option("timeout", options.timeout, kTimeout);
  slop_ = static_cast<std::uint64_t>(std::llround(1e9 * options.slop));
}

bool CaptureJoin::fits(const Capture& capture, std::uint64_t stamp) const {
  return std::max(capture.last, stamp) - std::min(capture.first, stamp) <= slop_;
}

// A capture of too few sensors is none: it keeps its own late clouds back, for as long as they may come, and
// no others. One sensor whose clock is ahead would stop the booth until that time has come. Two sensors, or
// equal halves, do not say whose clock is right: the later ones keep back what comes in their slop.
bool CaptureJoin::has_left(int sensor, std::uint64_t stamp, double now, Fate& fate) {
  const auto newest =
      std::find_if(left_.rbegin(), left_.rend(), [](const Left& left) { return left.enough; });
  if (open_.empty() && newest != left_.rend() && stamp + kStartedOver < newest->capture.first) left_.clear();
  for (const Left& left : left_) {
    const auto& sent = left.capture.clouds[sensor];
    fate = sent && sent->stamp == stamp ? Fate::played : Fate::late;
    if (fate == Fate::played || (left.enough && stamp <= left.capture.last)) return true;
    const bool waits =
        !left.capture.is_stray && now - left.at < timeout_;  // no other sensor's belong to a stray
    if (!sent && fits(left.capture, stamp) && (left.enough || waits)) return true;
  }
  return false;
}

CaptureJoin::Fate CaptureJoin::add(int sensor, std::shared_ptr<const SensorCloud> cloud, double now) {
  const std::uint64_t stamp = cloud->stamp;
  Fate fate = Fate::taken;
  if (has_left(sensor, stamp, now, fate)) return fate;
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

// What comes at the same time is of one capture, whatever its stamps: sensors that are missing in one and
// make up a smaller one beside it have another clock.
void CaptureJoin::compare_clocks(Open& leaving, double now) const {
  Capture& capture = leaving.capture;
  const auto size = [this](const Capture& c) { return sensors_ - static_cast<int>(c.missing().size()); };
  const auto is_smaller = [&](const Capture& one, const Capture& other) {
    return std::make_pair(size(one), one.first) < std::make_pair(size(other), other.first);
  };
  const auto is_beside = [&](const Capture& other, double since) {
    for (int sensor = 0; sensor < sensors_; ++sensor)
      if (capture.clouds[sensor] && other.clouds[sensor]) return false;
    return std::abs(since - leaving.since) < timeout_ / 2;  // later ones are of the next capture
  };
  std::vector<const Capture*> others;
  for (const Open& open : open_)
    if (is_beside(open.capture, open.since)) others.push_back(&open.capture);
  for (const Left& left : left_)
    if (now - left.at <= timeout_ && is_beside(left.capture, left.since)) others.push_back(&left.capture);
  const bool enough = capture.seeing() >= min_sensors_;
  for (const Capture* other : others) {
    const bool is_stray = is_smaller(capture, *other);
    if (is_stray && (enough || capture.is_stray)) continue;
    const Capture& strays = is_stray ? capture : *other;
    const Capture& rest = is_stray ? *other : capture;
    OtherClock clock{{}, 1e-9 * (static_cast<double>(strays.first) - static_cast<double>(rest.first))};
    for (int sensor = 0; sensor < sensors_; ++sensor)
      if (strays.clouds[sensor]) clock.sensors.push_back(sensor);
    if (is_stray) capture.other_clocks.clear();
    capture.other_clocks.push_back(std::move(clock));
    capture.is_stray = is_stray;
    if (is_stray) return;
  }
}

std::optional<Capture> CaptureJoin::next(double now) {
  // One that ends for want of sensors pushes no older one out.
  auto leaving = std::find_if(open_.begin(), open_.end(), [&](const Open& open) {
    return is_late(open, now) && open.capture.seeing() < min_sensors_;
  });
  if (leaving == open_.end()) {
    const bool due =
        open_.size() > kMostOpen || std::any_of(open_.begin(), open_.end(), [&](const Open& open) {
          return is_late(open, now) || open.capture.missing().empty();
        });
    if (!due) return std::nullopt;
    leaving = open_.begin();
  }
  Open open = std::move(*leaving);
  open_.erase(leaving);
  compare_clocks(open, now);
  Left left{open.capture, open.since, now, open.capture.seeing() >= min_sensors_};
  for (auto& cloud : left.capture.clouds)  // a body's points are not kept
    if (cloud) cloud = std::make_shared<const SensorCloud>(SensorCloud{cloud->stamp, {}, {}});
  left_.push_back(std::move(left));
  if (left_.size() > kMostOpen) left_.pop_front();
  return std::move(open.capture);
}

}  // namespace tensegric_fit::assembler
