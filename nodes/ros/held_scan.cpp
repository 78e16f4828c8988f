#include "ros/held_scan.hpp"

#include <utility>

namespace tensegric_fit::node {

HeldScan& HeldScan::of_process() {
  static HeldScan held;
  return held;
}

void HeldScan::begin(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!begun_.empty() && begun_ != scan_id) begun_before_.insert(begun_);
  begun_ = scan_id;
}

void HeldScan::wait(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_ = scan_id;
}

void HeldScan::work(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_.clear();
  working_ = scan_id;
  tried_.insert(scan_id);
}

void HeldScan::rest() {
  const std::lock_guard<std::mutex> lock(mutex_);
  working_.clear();
}

void HeldScan::publish(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  published_ = scan_id;
  tried_.clear();
  begun_before_.clear();
}

void HeldScan::begin_beside(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  beside_.insert(scan_id);
}

HeldScan::Export::Export(HeldScan& held, std::string scan_id) : held_(held), scan_id_(std::move(scan_id)) {
  const std::lock_guard<std::mutex> lock(held_.mutex_);
  held_.exported_.insert(scan_id_);
}

HeldScan::Export::~Export() {
  const std::lock_guard<std::mutex> lock(held_.mutex_);
  held_.exported_.erase(held_.exported_.find(scan_id_));
}

void HeldScan::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::string* scan_id : {&begun_, &waiting_, &working_, &published_}) scan_id->clear();
  tried_.clear();
  begun_before_.clear();
  beside_.clear();
}

void HeldScan::forget(const std::string& scan_id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  forgotten_.insert(scan_id);
}

bool HeldScan::is_busy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !working_.empty() || !exported_.empty();
}

bool HeldScan::is_forgotten(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return forgotten_.count(scan_id) != 0;
}

bool HeldScan::holds(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return begun_ == scan_id || waiting_ == scan_id || working_ == scan_id || published_ == scan_id ||
         tried_.count(scan_id) != 0 || beside_.count(scan_id) != 0 || exported_.count(scan_id) != 0 ||
         begun_before_.count(scan_id) != 0;
}

bool HeldScan::must_finish(const std::string& scan_id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return (begun_ != scan_id && (!waiting_.empty() || !working_.empty())) || exported_.count(scan_id) != 0;
}

}  // namespace tensegric_fit::node
