/// Which clouds of a booth's sensors belong to one capture.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/point_cloud.hpp"
#include "geometry/slop.hpp"

namespace tensegric_fit::assembler {

/// What one sensor sent: points in its own frame, the origin of which is its viewpoint, unless others are in
/// it, too (shared_frames.hpp).
struct SensorCloud {
  std::uint64_t stamp;  ///< ns
  std::string frame_id;
  geometry::PointCloud cloud;
};

/// Sensors whose clouds came together with a capture's, but were stamped `seconds` later than those.
struct OtherClock {
  std::vector<int> sensors;
  double seconds;
};

struct Capture {
  std::uint64_t first, last;                               ///< stamps, ns
  std::vector<std::shared_ptr<const SensorCloud>> clouds;  ///< one per sensor, null where none came
  std::vector<OtherClock> other_clocks = {};
  bool is_stray = false;  ///< of sensors that are missing in a larger one: other_clocks has them

  std::vector<int> missing() const;
  std::vector<int> blind() const;  ///< sensors whose clouds have no finite point
  int seeing() const;              ///< how many sensors are neither
};

/// A sentence that names the topics.
std::string words_of(const OtherClock& clock, const std::vector<std::string>& topics);

inline constexpr geometry::Range kTimeout{0.01, 600};

/// Field defaults are the parameters' defaults. Seconds.
struct CaptureOptions {
  double slop = geometry::kUsualSlop;  ///< between the first and the last stamp of a capture
  double timeout = 2.0;                ///< how long a capture waits after its first cloud has come
  int min_sensors = 0;  ///< that saw something: with fewer, a capture keeps no later one back; 0: any
};

/// Sorts clouds into captures by their stamps. Captures leave in the order of their stamps, each once; a
/// cloud that comes after its capture has left is dropped. For one thread. Times are seconds of any steady
/// clock.
class CaptureJoin {
 public:
  enum class Fate {
    taken,
    late,      ///< its capture, or a newer one, has left already
    repeated,  ///< its sensor has sent it before, and its capture still waits for others
    played,    ///< its capture has left with it: a recording that is played again, or a latched sensor
  };

  /// \throw Refusal bad_option naming the option and its range
  CaptureJoin(int sensors, const CaptureOptions& options);

  /// \pre 0 <= sensor < sensors
  Fate add(int sensor, std::shared_ptr<const SensorCloud> cloud, double now);

  /// The oldest capture, if it or a newer one is complete or has waited long enough. Call it until there is
  /// none.
  std::optional<Capture> next(double now);

 private:
  struct Open {
    Capture capture;
    double since;
  };
  struct Left {
    Capture capture;  // stamps alone
    double since, at;
    bool enough;  // sensors
  };
  bool fits(const Capture& capture, std::uint64_t stamp) const;
  bool has_left(int sensor, std::uint64_t stamp, double now, Fate& fate);
  bool is_late(const Open& open, double now) const { return now - open.since >= timeout_; }
  void compare_clocks(Open& leaving, double now) const;

  int sensors_, min_sensors_;
  std::uint64_t slop_;
  double timeout_;
  std::vector<Open> open_;  // in the order of their stamps
  std::deque<Left> left_;   // in the order in which they left
};

}  // namespace tensegric_fit::assembler
