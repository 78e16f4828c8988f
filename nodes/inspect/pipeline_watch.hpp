/// What the stages say of themselves, in one sentence.
#pragma once

#include <map>
#include <string>

namespace tensegric_fit::inspect {

/// Words of a stage on /diagnostics.
struct StageReport {
  std::string stage;    ///< reconstruction, landmarks, control_mesh, tensegric, tffd
  std::string state;    ///< waiting, working, done, superseded, refused, failed
  std::string message;  ///< a sentence
  std::string scan_id;
};

class PipelineWatch {
 public:
  /// Seconds of silence after which a stage counts as dead: each speaks once a second.
  static constexpr double kSilence = 3;

  /// `now` in seconds of any steady clock.
  void hear(const StageReport& report, double now);

  /// How it stands, for people.
  struct State {
    std::string words;
    bool trouble;  ///< something was refused, failed, or is silent
    bool working;
    int done, all;            ///< stages that are through with the newest scan
    std::string newest_scan;  ///< id of the scan that came last, whatever became of it; empty: unknown
  };
  State state(double now) const;

 private:
  struct Heard {
    StageReport report;
    double at;
  };
  std::map<std::string, Heard> stages_;
};

}  // namespace tensegric_fit::inspect
