#include "ros/stage.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_msgs/KeyValue.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>

#include "ros/freed_memory.hpp"
#include "ros/held_scan.hpp"
#include "ros/log_words.hpp"

namespace tensegric_fit::node {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// Names and frames of messages are of any length, and a report is sent again every second.
std::string cut(const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  return text.substr(0, kLongest);
}

diagnostic_msgs::KeyValue fact(const std::string& key, const std::string& value) {
  diagnostic_msgs::KeyValue pair;
  pair.key = key;
  pair.value = cut(value);
  return pair;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// The most memory that this process had so far.
double peak_mebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

geometry::Refusal superseded_by_newer(const std::string& scan_id) {
  return {geometry::refusal::kSuperseded, "a newer scan came before scan " + scan_id + " was done"};
}

}  // namespace

Stage::Stage(std::string name, const ros::NodeHandle& node) : name_(std::move(name)) {
  ros::NodeHandle handle(node);
  diagnostics_ = handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 16);
  // For all lives of the node: Python's subscribers do not always come back to a topic that ends and begins
  // again. Never ended: ROS is gone when static objects are.
  static auto* const kept = new ros::Publisher(diagnostics_);
  static_cast<void>(kept);
  heartbeat_ = handle.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
    std::lock_guard<std::mutex> lock(report_mutex_);
    report();
  });
  worker_ = std::thread([this] { serve(); });
}

Stage::~Stage() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  worker_.join();
}

void Stage::begin(const std::string& scan_id) {
  if (HeldScan::of_process().is_forgotten(scan_id)) return;
  std::lock_guard<std::mutex> lock(mutex_);
  newest_scan_ = scan_id;
  HeldScan::of_process().begin(scan_id);
}

void Stage::post(const std::string& scan_id, Work work) {
  put({scan_id, std::move(work), false});
}

void Stage::post_passing(const std::string& scan_id, Work work) {
  put({scan_id, std::move(work), true});
}

void Stage::put(Job job) {
  if (HeldScan::of_process().is_forgotten(job.scan_id)) return;
  std::optional<Job> overtaken;
  {
    std::lock_guard<std::mutex> lock(mutex_);
    HeldScan::of_process().wait(job.scan_id);
    if (waiting_ && waiting_->scan_id != job.scan_id) overtaken = std::move(waiting_);
    waiting_ = std::move(job);
  }
  wake_.notify_one();
  if (overtaken) say_superseded(*overtaken);
}

// A scan that has no result is named, not only where something of it is wrong.
void Stage::say_superseded(const Job& job) {
  if (job.passing || HeldScan::of_process().is_forgotten(job.scan_id)) return;
  drop(job.scan_id, superseded_by_newer(job.scan_id));
}

bool Stage::outdated(const std::string& scan_id) const {
  std::lock_guard<std::mutex> lock(mutex_);
  return stopping_ || newest_scan_ != scan_id || waiting_.has_value();
}

bool Stage::is_stopping() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return stopping_;
}

bool Stage::is_unwanted(const std::string& scan_id) const {
  if (HeldScan::of_process().is_forgotten(scan_id)) return true;
  std::lock_guard<std::mutex> lock(mutex_);
  return stopping_ || newest_scan_ != scan_id;
}

void Stage::refuse(const std::string& scan_id, const geometry::Refusal& refusal) {
  fail(scan_id, "refused", refusal.code(), refusal.what());
}

void Stage::drop(const std::string& scan_id, const geometry::Refusal& refusal) {
  std::lock_guard<std::mutex> lock(report_mutex_);
  state_.last_error = {refusal.code(), refusal.what(), scan_id};
  report();
  ROS_WARN("%s: dropped: %s", name_.c_str(), log_words(refusal.code() + ": " + refusal.what()).c_str());
}

void Stage::serve() {
  while (true) {
    Job job;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || waiting_.has_value(); });
      if (stopping_) return;
      job = std::move(*waiting_);
      waiting_.reset();
      HeldScan::of_process().work(job.scan_id);
    }
    run(job);
    job = {};
    let_go_of_pieces();
    HeldScan::of_process().rest();
  }
}

void Stage::run(const Job& job) {
  if (is_unwanted(job.scan_id)) {
    if (!is_stopping()) say_superseded(job);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  if (!job.passing) {
    std::lock_guard<std::mutex> lock(report_mutex_);
    state_.word = "working";
    state_.message = "working on scan " + job.scan_id;
    state_.scan_id = job.scan_id;
    state_.level = DiagnosticStatus::OK;
    state_.working_since = start;
    state_.milliseconds = 0;
    state_.facts.clear();  // of another scan, or of the garment before
    report();
  }
  try {
    const Result result = job.work();
    finish(job, result, milliseconds_since(start));
  } catch (const geometry::Refusal& refusal) {
    fail(job.scan_id, "refused", refusal.code(), refusal.what());
  } catch (const std::exception& error) {
    fail(job.scan_id, "failed", "internal_error", error.what());
  }
}

void Stage::finish(const Job& job, const Result& result, double milliseconds) {
  const bool unwanted = is_unwanted(job.scan_id), dropped = !result.publish || unwanted,
             superseded = unwanted && !is_stopping();
  if (!dropped) result.publish();
  if (job.passing) return;
  if (!dropped) HeldScan::of_process().publish(job.scan_id);
  std::lock_guard<std::mutex> lock(report_mutex_);
  const State before = state_;  // another scan may have been refused meanwhile
  state_.scan_id = job.scan_id;
  state_.level = DiagnosticStatus::OK;
  if (superseded) {
    const geometry::Refusal why = superseded_by_newer(job.scan_id);
    state_.last_error = {why.code(), why.what(), job.scan_id};
  }
  state_.word = dropped ? "superseded" : "done";
  state_.message = dropped ? "dropped work on scan " + job.scan_id + ": something newer came" : "done";
  if (!dropped && !result.warning.empty()) {
    state_.level = DiagnosticStatus::WARN;
    state_.message = result.warning;
    ROS_WARN("%s: scan %s: %s", name_.c_str(), job.scan_id.c_str(), log_words(result.warning).c_str());
  }
  state_.working_since.reset();
  state_.milliseconds = milliseconds;
  state_.facts = result.facts;
  report();
  if (before.word == "refused" && !before.scan_id.empty() && before.scan_id != job.scan_id) {
    state_ = before;  // it came last, and is shown until the next
    report();
  }
  ROS_INFO("%s: scan %s %s in %.1f ms", name_.c_str(), job.scan_id.c_str(), dropped ? "superseded" : "done",
           milliseconds);
}

void Stage::fail(const std::string& scan_id, const std::string& word, const std::string& code,
                 const std::string& message) {
  std::lock_guard<std::mutex> lock(report_mutex_);
  state_.working_since.reset();
  state_.word = word;
  state_.message = code + ": " + message;
  state_.scan_id = scan_id;
  state_.level = DiagnosticStatus::ERROR;
  state_.milliseconds = 0;
  state_.facts.clear();
  state_.last_error = {code, message, scan_id};
  report();
  ROS_ERROR("%s: scan %s %s: %s", name_.c_str(), scan_id.c_str(), word.c_str(),
            log_words(code + ": " + message).c_str());
}

/// A report is given again every second, for as long as the node lives.
void Stage::leave_out_forgotten() {
  const HeldScan& held = HeldScan::of_process();
  if (held.is_forgotten(state_.last_error.scan_id)) state_.last_error = {};
  if (state_.working_since || !held.is_forgotten(state_.scan_id)) return;
  const Error last = state_.last_error;
  state_ = {};
  state_.last_error = last;
}

void Stage::report() {
  leave_out_forgotten();
  DiagnosticStatus status;
  status.level = state_.level;
  status.name = ros::this_node::getName().substr(1) + ": " + name_;
  status.message = cut(state_.message);
  const double working = state_.working_since ? milliseconds_since(*state_.working_since) / 1000 : 0;
  if (working > kSlow) {
    status.level = DiagnosticStatus::WARN;
    status.message = fmt::format("slow: {} for {:.0f} s", state_.message, working);
  }
  status.hardware_id = "tensegric_fit";
  status.values = {fact("state", state_.word),
                   fact("scan_id", state_.scan_id),
                   fact("working_seconds", fmt::format("{:.1f}", working)),
                   fact("milliseconds", fmt::format("{:.3f}", state_.milliseconds)),
                   fact("peak_mebibytes", fmt::format("{:.1f}", peak_mebibytes())),
                   fact("last_error", state_.last_error.code),
                   fact("last_error_message", state_.last_error.message),
                   fact("last_error_scan_id", state_.last_error.scan_id)};
  for (const auto& [key, value] : state_.facts) status.values.push_back(fact(key, value));

  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = ros::Time::now();
  array.status.push_back(std::move(status));
  diagnostics_.publish(array);
}

}  // namespace tensegric_fit::node
