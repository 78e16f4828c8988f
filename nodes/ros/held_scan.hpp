/// Which scans this process holds something of.
#pragma once

#include <mutex>
#include <set>
#include <string>

namespace tensegric_fit::node {

/// A stage holds what has come of a scan, what its worker is at, which may be of a scan before the newest,
/// what it published last, which stays latched while it works on the next, and what it exports. For any
/// thread.
class HeldScan {
 public:
  /// Of this process: its stage says what it holds, its main function asks.
  static HeldScan& of_process();

  void begin(const std::string& scan_id);    ///< its data have come; what came before may still be kept
  void wait(const std::string& scan_id);     ///< work on it waits, in place of any that waited
  void work(const std::string& scan_id);     ///< the work that waited is under way
  void rest();                               ///< it is over
  void publish(const std::string& scan_id);  ///< it took the place of what was published before
  /// The data of a second scan have come, which a stage compares with the first, or keeps for later. It is
  /// held from then on: what is published may name any of those that came.
  void begin_beside(const std::string& scan_id);
  /// While it lives, an export of that scan is written.
  class Export {
   public:
    Export(HeldScan& held, std::string scan_id);
    ~Export();
    Export(const Export&) = delete;
    Export& operator=(const Export&) = delete;

   private:
    HeldScan& held_;
    const std::string scan_id_;
  };

  void clear();
  /// It is not worked on again, should it come again: a booth may latch it.
  void forget(const std::string& scan_id);

  bool is_busy() const;  ///< work is under way, or an export is written
  bool is_forgotten(const std::string& scan_id) const;
  bool holds(const std::string& scan_id) const;
  /// Before that scan is let go of: work, where the newest scan is another one, whose data would be lost by
  /// starting afresh; an export of the scan, which would be there after all exports were deleted.
  bool must_finish(const std::string& scan_id) const;

 private:
  mutable std::mutex mutex_;
  std::string begun_, waiting_, working_, published_;  // empty: none
  std::set<std::string> tried_;  // worked on since something was published: work that failed leaves its data
  // Before the newest, since something was published: of each topic that a stage joins one may be kept.
  std::set<std::string> begun_before_;
  std::set<std::string> beside_, forgotten_;
  std::multiset<std::string> exported_;  // at this moment
};

/// Whether what `message` points to is of a scan that this process forgot.
template <typename Pointer>
auto is_of_forgotten(const Pointer& message) -> decltype(message->scan_id.empty()) {
  return HeldScan::of_process().is_forgotten(message->scan_id);
}
template <typename... OfNoScan>
bool is_of_forgotten(const OfNoScan&...) {
  return false;
}

}  // namespace tensegric_fit::node
