/// Whose the scans are.
#pragma once

#include <tensegric_fit/ScanLabel.h>

#include <deque>
#include <string>

namespace tensegric_fit::node {

/// What labels said of the newest scans. For one thread.
class ScanLabels {
 public:
  static constexpr std::size_t kKept = 64;  ///< scans: a day's latecomers

  void add(const ScanLabel& label);

  void drop(const std::string& scan_id);

  /// What is known of it; its scan_id alone where nothing is.
  ScanLabel of(const std::string& scan_id) const;

 private:
  std::deque<ScanLabel> labels_;  // one per scan, oldest first
};

}  // namespace tensegric_fit::node
