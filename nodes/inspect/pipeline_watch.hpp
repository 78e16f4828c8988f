/// What the stages say of themselves, in one sentence.
#pragma once

#include <deque>
#include <map>
#include <string>

#include "geometry/stage_report.hpp"

namespace tensegric_fit::inspect {

using geometry::StageReport;

class PipelineWatch {
 public:
  /// Seconds for which something that a stage dropped is shown.
  static constexpr double kNews = 30;

  /// `start`: when it began to listen; stages have until geometry::kSilent after it to report. Times in
  /// seconds of any steady clock.
  explicit PipelineWatch(double start = -geometry::kSilent) : start_(start) {}

  void hear(const StageReport& report, double now);

  /// How it stands, for people.
  struct State {
    std::string words;
    bool trouble;  ///< something was refused, failed, or is silent
    bool working;
    int done, all;  ///< stages that are through with the newest scan; of a chain that only measures two
    std::string
        newest_scan;  ///< id of the scan that came last, whatever became of it and of the stages since
  };
  State state(double now) const;

 private:
  struct Heard {
    StageReport report;
    double at;       // heard last
    double said_at;  // since when state and message are these
  };
  bool is_lone(const StageReport& report) const;
  bool fits_garments() const;
  void look_at_booth(double now, State& state) const;
  void add_warnings(State& state) const;

  double start_;
  std::map<std::string, Heard> stages_;
  StageReport dropped_;  // the last that a stage named without a change of state
  double dropped_at_ = -kNews;
  std::string newest_, refused_;  // the last that came to the chain; what the booth refused since
  bool lone_ = false;             // newest_ is of a body that reconstruction did not make
  static constexpr std::size_t kRemembered = 16;  // scans: more than any stage lags behind
  std::deque<std::string> made_;                  // scans that reconstruction took, newest last
  double scan_at_ = 0;  // when the newest scan came: what the booth refused before is no news any more
};

}  // namespace tensegric_fit::inspect
