/// The service forget, and the end of exports that are old.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <tensegric_fit/Forget.h>
#include <tensegric_fit/ForgetAnswer.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "ros/parameters.hpp"

namespace tensegric_fit::node {

struct VaultOptions {
  std::vector<std::string> folders;  ///< absolute paths that exports lie in
  double retention_days = 0;         ///< that they are kept; 0: until they are deleted
};

/// \throw Refusal bad_option, naming the parameter
VaultOptions vault_options(Parameters parameters);

/// Serves in a thread of its own; answers of nodes come by the main thread.
class ForgetDesk {
 public:
  ForgetDesk(ros::NodeHandle node, const ros::NodeHandle& private_node);

 private:
  bool on_forget(Forget::Request& request, Forget::Response& response);
  /// Orders it and waits for those that are asked. Returns those that did not answer in time.
  std::set<std::string> let_go(const std::set<std::string>& asked, const Forget::Request& request,
                               Forget::Response& response);
  /// Returns whether there was one of it.
  static bool delete_exports_of(const std::string& scan_id, const std::string& folder,
                                Forget::Response& response);
  void delete_old();
  /// What came of the last look for old exports, again and again, as stages report.
  void report() const;

  ros::NodeHandle node_;
  const VaultOptions options_;
  ros::Publisher orders_;
  ros::Subscriber answers_in_;
  ros::Publisher diagnostics_;
  ros::WallTimer daily_, heartbeat_;
  std::set<std::string> left_in_;        // folders in which old exports may be left, at the last look
  std::atomic<bool> look_again_{false};  // a scan was forgotten since
  std::mutex mutex_;                     // guards answers_
  std::condition_variable answered_;
  std::map<std::string, ForgetAnswer> answers_;  // of nodes, to the order given last
  ros::CallbackQueue queue_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;  // last: it uses all of the above
};

}  // namespace tensegric_fit::node
