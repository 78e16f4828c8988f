/// A program that does one piece of work in a process of its own: what crashes, hangs or leaks there does so
/// there.
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// A child that gave no answer; what() says why, as the end of a sentence: "ended by signal 11 (...)".
struct ChildFailure : std::runtime_error {
  explicit ChildFailure(const std::string& why, int code = 0) : std::runtime_error(why), exit_code(code) {}
  int exit_code;  ///< its own, 0 where it did not end by itself
};

class ChildProcess {
 public:
  /// Starts `program` (geometry::spawn). \throw ChildFailure: it cannot be started
  explicit ChildProcess(const std::string& program, const std::vector<std::string>& arguments = {});
  /// Kills it where it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Gives it `input` and returns all that it writes, once it has ended with exit code 0. Once per object.
  /// \throw ChildFailure: it ended otherwise, or not within `seconds`
  std::string answer(const std::string& input, double seconds);

 private:
  pid_t process_ = -1;  // -1 once its end has been seen
  int channel_ = -1;
};

}  // namespace tensegric_fit::geometry
