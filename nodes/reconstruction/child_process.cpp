#include "reconstruction/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

namespace tensegric_fit::reconstruction {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBlock = std::size_t{1} << 16;  // bytes read at once

/// What a child starts with: `channel` as standard input and output, no other descriptor but standard error
/// (a socket of ROS that it held would stay open after the node closes it), no blocked or ignored signal.
class SpawnSettings {
 public:
  explicit SpawnSettings(int channel) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, channel, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, channel, STDOUT_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes);
    sigset_t none, usual;
    sigemptyset(&none);
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
};

/// Until the channel can be read or, where `writing`, written. \throw ChildFailure: not before the deadline
short ready(int channel, bool writing, Clock::time_point deadline, double seconds) {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd wanted{channel, static_cast<short>(writing ? POLLIN | POLLOUT : POLLIN), 0};
    const int result = poll(&wanted, 1, static_cast<int>(std::max<long long>(0, left)));
    if (result > 0) return wanted.revents;
    if (result == 0) throw ChildFailure(fmt::format("was not ready after {:g} s", seconds));
    if (errno != EINTR) throw ChildFailure(std::string("could not be waited for: ") + std::strerror(errno));
  }
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw ChildFailure(std::string("has no channel: ") + std::strerror(errno));
  channel_ = ends[0];
  const SpawnSettings settings(ends[1]);
  std::array<char*, 2> arguments{const_cast<char*>(program.c_str()), nullptr};
  const int error = posix_spawn(&process_, program.c_str(), &settings.actions, &settings.attributes,
                                arguments.data(), environ);
  close(ends[1]);
  if (error == 0) return;
  close(channel_);
  throw ChildFailure(fmt::format("cannot be started ({}): {}", program, std::strerror(error)));
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    wait_status();
  }
  close(channel_);
}

int ChildProcess::wait_status() {
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process_, &status, 0)) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (ended < 0) throw ChildFailure(std::string("was lost: ") + std::strerror(errno));
  return status;
}

std::string ChildProcess::answer(const std::string& input, double seconds) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  std::string output;
  std::size_t sent = 0;
  for (bool open = true; open;) {
    const short can = ready(channel_, sent < input.size(), deadline, seconds);
    if (sent < input.size() && (can & POLLOUT) != 0) {
      const ssize_t n = send(channel_, input.data() + sent, input.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      // A child that has ended takes no more: how it ended says why.
      sent = n >= 0                              ? sent + static_cast<std::size_t>(n)
             : errno == EAGAIN || errno == EINTR ? sent
                                                 : input.size();
      if (sent == input.size()) shutdown(channel_, SHUT_WR);
    }
    if ((can & (POLLIN | POLLHUP | POLLERR)) != 0) {
      std::array<char, kBlock> block;
      const ssize_t n = recv(channel_, block.data(), block.size(), MSG_DONTWAIT);
      if (n > 0) output.append(block.data(), static_cast<std::size_t>(n));
      open = n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
    }
  }
  const int status = wait_status();
  if (WIFSIGNALED(status))
    throw ChildFailure(fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
  if (WEXITSTATUS(status) != 0)
    throw ChildFailure(fmt::format("ended with exit code {}", WEXITSTATUS(status)), WEXITSTATUS(status));
  return output;
}

}  // namespace tensegric_fit::reconstruction
