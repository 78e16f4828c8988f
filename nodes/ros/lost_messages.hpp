/// Has a message been lost on its way from the stage before, or been overtaken?
#pragma once

#include <algorithm>
#include <deque>
#include <string>

namespace tensegric_fit::node {

/// One input of a stage beside what the stage before says on /diagnostics. Times are seconds of any steady
/// clock. For one thread.
class LostMessages {
 public:
  static constexpr double kPatience = 2;  ///< s between the report and its message, which went out before it

  /// The stage before is done with that scan: its message is on its way.
  void sent(const std::string& scan_id, double now) {
    reports_ = true;
    if (scan_id == sent_) return;
    before_.push_back(sent_);
    if (before_.size() > kRemembered) before_.pop_front();
    sent_ = scan_id;
    came_ = scan_id == heard_;
    since_ = now;
    tries_ = 0;
  }

  /// The stage before has begun to work on that scan, or is at it.
  void working(const std::string& scan_id) {
    reports_ = true;
    if (scan_id == heard_) ended_ = false;
  }

  void heard(const std::string& scan_id) {
    heard_ = scan_id;
    ended_ = true;
    came_ = came_ || scan_id == sent_;
  }

  /// Of a state on the way to the result of that scan: has the result overtaken it? It would take the
  /// result's place. States on the way to another result of the scan follow a report that the stage works on
  /// it.
  bool is_late(const std::string& scan_id) const { return reports_ && ended_ && scan_id == heard_; }

  /// A message of a scan before the one whose message has come; or of one that the stage before does once
  /// more, which its next report says.
  bool is_overtaken(const std::string& scan_id) const {
    return came_ && scan_id != sent_ && std::find(before_.begin(), before_.end(), scan_id) != before_.end();
  }

  enum class Advice {
    wait,
    connect_anew,  ///< what is latched comes with a connection
    give_up,       ///< lost: said once
  };
  Advice advice(double now) {
    if (sent_.empty() || came_ || tries_ > 1 || now - since_ < kPatience) return Advice::wait;
    since_ = now;
    return tries_++ == 0 ? Advice::connect_anew : Advice::give_up;
  }

 private:
  static constexpr std::size_t kRemembered = 16;  // scans

  std::string sent_, heard_;
  std::deque<std::string> before_;  // sent before sent_
  bool came_ = false;               // the message of sent_
  bool ended_ = false;              // heard_ was the last thing that the stage before made of its scan
  bool reports_ = false;            // the stage before says what it does
  double since_ = 0;
  int tries_ = 0;
};

}  // namespace tensegric_fit::node
