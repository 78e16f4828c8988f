/// Follows one capture from its sensors to its measurements.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "capture/stage_board.hpp"

namespace tensegric_fit::capture {

struct CaptureGoal {
  std::vector<std::string> sensors;  ///< that must take part; empty: any
  double timeout;                    ///< s
  bool with_fit = false;             ///< ends with the garment on, not with the measurements
  /// ns; a scan with an older stamp is another's. One without a stamp (0) counts once the trigger was pulled.
  std::uint64_t not_before = 0;
};

/// `CaptureGoal::not_before` while nothing counts.
inline constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

/// How far a capture has come.
struct CaptureProgress {
  std::string stage;
  double share;         ///< 0 to 1
  std::string message;  ///< for people
  std::vector<std::string> missing;
};

/// How it ended; an empty code: well.
struct CaptureEnd {
  std::string code, message;
};

/// Takes the first scan that comes, and nothing of another. Times are seconds of any steady clock. For one
/// thread.
class CaptureWatch {
 public:
  /// `board` must outlive it. `slop`: s between a scan's stamp and those of its clouds.
  CaptureWatch(CaptureGoal goal, const StageBoard& board, double slop, double now);

  void add_cloud(const std::string& sensor, std::uint64_t stamp);
  /// One that was heard before the goal came: it counts if it is of the scan.
  void add_earlier_cloud(const std::string& sensor, std::uint64_t stamp);
  void add_scan(const std::string& scan_id, std::uint64_t stamp);
  void add_landmarks(const std::string& scan_id) { measured_.insert(scan_id); }
  void add_fit(const std::string& scan_id) { fitted_.insert(scan_id); }
  /// A stage has just refused something: StageBoard::report. Only a stage before the scan ends the wait for
  /// it.
  void add_refusal(const StageReport& report);

  const std::string& scan_id() const { return scan_id_; }
  CaptureProgress progress(double now);
  /// Nothing while it is under way.
  std::optional<CaptureEnd> end(double now) const;

 private:
  bool is_early(std::uint64_t stamp) const;
  void note_early(std::uint64_t stamp, int count);
  bool was_heard(const std::string& sensor) const;
  std::vector<std::string> missing() const;
  std::string stage() const;
  std::string waiting_for(double now) const;
  bool is_complete() const;
  std::optional<CaptureEnd> dead_stage(double now) const;
  std::string warnings() const;

  const CaptureGoal goal_;
  const StageBoard& board_;
  const std::uint64_t slop_;
  const double start_;
  std::map<std::string, std::vector<std::uint64_t>> clouds_, earlier_clouds_;  // stamps, by sensor
  std::string scan_id_;
  std::uint64_t stamp_ = 0;                  // of the scan
  std::set<std::string> measured_, fitted_;  // scans; a message may overtake its scan
  std::optional<CaptureEnd> refused_;
  std::uint64_t early_ = 0;  // the newest stamp that did not count, though a scan was asked for
  int early_count_ = 0;      // more than those that were on their way then
  double share_ = 0;
};

}  // namespace tensegric_fit::capture
