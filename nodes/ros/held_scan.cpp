#include "ros/held_scan.hpp"

namespace tensegric_fit::node {

HeldScan& HeldScan::of_process() {
  static HeldScan held;
  return held;
}

void HeldScan::begin(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  begun_ = scan_id;
}

void HeldScan::publish(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  published_ = scan_id;
}

void HeldScan::work(bool working) {
  const std::lock_guard<std::mutex> lock(mutex_);
  working_ = working;
}

void HeldScan::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  begun_.clear();
  published_.clear();
  working_ = false;
}

void HeldScan::forget(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  forgotten_.insert(scan_id);
}

bool HeldScan::is_forgotten(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return forgotten_.count(scan_id) != 0;
}

bool HeldScan::holds(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return begun_ == scan_id || published_ == scan_id;
}

bool HeldScan::works_on_other(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return working_ && begun_ != scan_id;
}

}  // namespace tensegric_fit::node
