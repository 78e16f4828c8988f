/// Starting a program in a process of its own.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tensegric_fit::geometry {

struct SpawnedProcess {
  pid_t id = -1;  ///< the caller waits for it
  /// A stream socket, the other end of its standard input and output; the caller closes it.
  int channel = -1;
};

/// Starts `program`. It has standard error of this process and no other of its descriptors (a socket of ROS
/// that it held would stay open after the node closes it), and no blocked signals, and the usual ends
/// by SIGPIPE, SIGINT and SIGTERM. Where this process ignores SIGCHLD, it does not from then on: ends of
/// children would be lost.
/// \throw std::runtime_error, as the end of a sentence: it cannot be started
SpawnedProcess spawn(const std::string& program, const std::vector<std::string>& arguments = {});

/// Waits until it has ended, for waitpid's status. \throw std::runtime_error
int wait_for(pid_t process);

/// How a process ended that did not end with exit code 0, as the end of a sentence.
std::string ending(int wait_status);

/// A program that lies beside the running one.
std::string sibling_program(const std::string& name);

}  // namespace tensegric_fit::geometry
