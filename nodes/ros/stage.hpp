/// What all stage nodes share: one worker, one mailbox, and /diagnostics.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/ros.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "geometry/status.hpp"
#include "ros/facts.hpp"

namespace tensegric_fit::node {

/// Runs the work of a stage in a thread of its own. One piece of work waits at most: the newest. What a piece
/// of work found is published only if no newer scan was begun meanwhile, and its own is not to be forgotten.
/// A Refusal or another exception ends that piece of work alone: it is named on /diagnostics and in the log,
/// and nothing is published. It reports every second whatever the worker does: one that is silent for longer
/// is dead, one that reports `working_seconds` beyond kSlow is slow.
class Stage {
 public:
  using Facts = node::Facts;
  static constexpr double kSlow = 10;  ///< seconds; no stage takes half as long on two cores

  /// What work ends with: how to publish it (empty where it stopped half way), and what to say of it on
  /// /diagnostics. A warning is for what came out, but not as it should.
  struct Result {
    std::function<void()> publish;
    Facts facts;
    std::string warning = {};
  };
  using Work = std::function<Result()>;

  /// `name` is the stage's name in diagnostics and log.
  Stage(std::string name, const ros::NodeHandle& node);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// A new scan has come: what is found for any other is dropped from now on.
  void begin(const std::string& scan_id);

  /// Work for that scan, in place of any that waits.
  void post(const std::string& scan_id, Work work);

  /// The same, on the way to a result that other work will bring: nothing is said of it but trouble.
  void post_passing(const std::string& scan_id, Work work);

  /// True once another scan was begun or newer work waits. For work that can stop half way.
  bool outdated(const std::string& scan_id) const;

  /// Says that an input was refused before any work began.
  void refuse(const std::string& scan_id, const geometry::Refusal& refusal);

  /// Says that an input was dropped that no work waits for: named like a refusal, but the state stays.
  void drop(const std::string& scan_id, const geometry::Refusal& refusal);

 private:
  struct Job {
    std::string scan_id;
    Work work;
    bool passing;
  };
  struct Error {
    std::string code, message, scan_id;
  };
  struct State {
    std::string word = "waiting", message = "waiting for input", scan_id;
    std::uint8_t level = diagnostic_msgs::DiagnosticStatus::OK;
    Error last_error;
    std::optional<std::chrono::steady_clock::time_point> working_since;
    double milliseconds = 0;
    Facts facts;
  };

  void put(Job job);
  void serve();
  bool is_stopping() const;
  bool is_unwanted(const std::string& scan_id) const;
  void say_superseded(const Job& job);
  void run(const Job& job);
  void fail(const std::string& scan_id, const std::string& word, const std::string& code,
            const std::string& message);
  void finish(const Job& job, const Result& result, double milliseconds);
  void report();
  void leave_out_forgotten();

  const std::string name_;
  ros::Publisher diagnostics_;
  ros::WallTimer heartbeat_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::string newest_scan_;
  std::optional<Job> waiting_;
  bool stopping_ = false;

  std::mutex report_mutex_;  // guards state_, and the order of what is said
  State state_;

  std::thread worker_;  // last: it uses all of the above
};

}  // namespace tensegric_fit::node
