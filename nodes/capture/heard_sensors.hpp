/// What sensors have sent, whether or not a goal was open.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "capture/capture_watch.hpp"

namespace tensegric_fit::capture {

/// The clouds of a scan may come before the goal that it answers: the stamps of the last ones are kept. Times
/// are seconds of any steady clock. For one thread.
class HeardSensors {
 public:
  /// s before a goal within which the clouds of its scan came: longer than a capture takes, from its first
  /// cloud on; shorter than it takes until the next customer stands there. What came sooner is another's.
  static constexpr double kOfThisCustomer = 10;

  /// Remembers the clouds of these sensors from now on, and gives the watch those of the last
  /// kOfThisCustomer.
  void follow(const std::vector<std::string>& sensors, double now, CaptureWatch& watch);

  /// Nothing where the sensor is not listened to. `now`: when the cloud came.
  void add(const std::string& sensor, std::uint64_t stamp, double now);

 private:
  struct Cloud {
    std::uint64_t stamp;
    double came;
  };
  std::map<std::string, std::deque<Cloud>> heard_;
};

}  // namespace tensegric_fit::capture
