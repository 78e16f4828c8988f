/// Which scans this process holds something of.
#pragma once

#include <mutex>
#include <set>
#include <string>

namespace tensegric_fit::node {

/// A stage holds at most two: what it published last stays latched while it works on the next. For any
/// thread.
class HeldScan {
 public:
  /// Of this process: its stage says what it holds, its main function asks.
  static HeldScan& of_process();

  void begin(const std::string& scan_id);    ///< its data have come
  void publish(const std::string& scan_id);  ///< it took the place of what was published before
  void work(bool working);
  void clear();
  /// It is not worked on again, should it come again: a booth may latch it.
  void forget(const std::string& scan_id);

  bool is_forgotten(const std::string& scan_id) const;
  bool holds(const std::string& scan_id) const;
  /// It works on another one, whose data would be lost by starting afresh.
  bool works_on_other(const std::string& scan_id) const;

 private:
  mutable std::mutex mutex_;
  std::string begun_, published_;
  bool working_ = false;
  std::set<std::string> forgotten_;
};

}  // namespace tensegric_fit::node
