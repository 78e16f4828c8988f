/// What the stages of a chain said last: which of them are slow, and which are dead.
#pragma once

#include <map>
#include <string>

#include "geometry/stage_report.hpp"

namespace tensegric_fit::capture {

using geometry::StageReport;

/// Stages report once a second, whatever they do. Times are seconds of any steady clock.
class StageBoard {
 public:
  static constexpr double kSlow = 10;  ///< s on one piece of work
  static constexpr double kGone = 10;  ///< s without a report: not one that is just being started again

  /// True where the stage has just refused something: not for a report that repeats it.
  bool report(const StageReport& report, double now);

  /// Null where the stage never said anything.
  const StageReport* find(const std::string& stage) const;

  /// For how long it has been at its current work, s; 0 where it has none.
  double working_seconds(const std::string& stage, double now) const;

  /// For how long it has said nothing, s; since `since` where it never did.
  double silent_seconds(const std::string& stage, double since, double now) const;

  /// Sentences about stages that are slow, and that were heard and are silent now; empty where all is well.
  std::string trouble(double now) const;

 private:
  struct Heard {
    StageReport report;
    double at;
  };
  std::map<std::string, Heard> stages_;
};

}  // namespace tensegric_fit::capture
