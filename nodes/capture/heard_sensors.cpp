#include "capture/heard_sensors.hpp"

namespace tensegric_fit::capture {
namespace {

constexpr std::size_t kCloudsKept = 256;  // of a sensor: eight seconds of one that sends at 30 Hz

}  // namespace

void HeardSensors::follow(const std::vector<std::string>& sensors, double now, CaptureWatch& watch) {
  for (const std::string& sensor : sensors)
    for (const Cloud& cloud : heard_[sensor])
      if (now - cloud.came <= kOfThisCustomer) watch.add_earlier_cloud(sensor, cloud.stamp);
}

void HeardSensors::add(const std::string& sensor, std::uint64_t stamp, double now) {
  const auto heard = heard_.find(sensor);
  if (heard == heard_.end()) return;
  std::deque<Cloud>& clouds = heard->second;
  clouds.push_back({stamp, now});
  if (clouds.size() > kCloudsKept) clouds.pop_front();
}

}  // namespace tensegric_fit::capture
