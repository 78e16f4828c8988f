/// What a stage says of itself on /diagnostics: for the panel, and for who follows a capture.
#pragma once

#include <string>

namespace tensegric_fit::geometry {

/// s without a report after which a stage counts as dead: each speaks once a second, so three are missing,
/// and half a second is for a machine that is busy.
inline constexpr double kSilent = 3.5;

struct StageReport {
  std::string stage;    ///< reconstruction, landmarks, control_mesh, tensegric, tffd; assembler, scan_player
  std::string state;    ///< waiting, working, done, superseded, refused, failed
  std::string message;  ///< a sentence
  std::string scan_id;  ///< that the state is about
  bool warns = false;   ///< it is done, and `message` says what is not as it should be
  std::string last_error = {};  ///< a sentence: what it refused last, or dropped without a change of state
  std::string code = {};        ///< of that
  double working_seconds = 0;   ///< on the current work

  /// Whether it refused that scan.
  bool refused() const { return state == "refused" || state == "failed"; }
};

}  // namespace tensegric_fit::geometry
