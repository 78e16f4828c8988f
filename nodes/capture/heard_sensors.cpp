#include "capture/heard_sensors.hpp"

namespace tensegric_fit::capture {
namespace {

constexpr std::size_t kStampsKept = 256;  // of a sensor: eight seconds of one that sends at 30 Hz

}  // namespace

void HeardSensors::follow(const std::vector<std::string>& sensors, double now, CaptureWatch& watch) {
  for (const std::string& sensor : sensors) {
    const Heard& heard = heard_.try_emplace(sensor, Heard{now, {}}).first->second;
    watch.connects(sensor, heard.since + kConnecting);
    for (const std::uint64_t stamp : heard.stamps) watch.add_earlier_cloud(sensor, stamp);
  }
}

void HeardSensors::add(const std::string& sensor, std::uint64_t stamp) {
  const auto heard = heard_.find(sensor);
  if (heard == heard_.end()) return;
  std::deque<std::uint64_t>& stamps = heard->second.stamps;
  stamps.push_back(stamp);
  if (stamps.size() > kStampsKept) stamps.pop_front();
}

}  // namespace tensegric_fit::capture
