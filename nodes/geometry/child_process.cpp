#include "geometry/child_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "geometry/spawned_process.hpp"

namespace tensegric_fit::geometry {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kBlock = std::size_t{1} << 16;  // bytes read at once

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

/// Its waitpid status once it has ended: it may close its channel and live on. \throw ChildFailure
int end_of(pid_t process, Clock::time_point deadline, double seconds) {
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process, &status, WNOHANG)) == 0) {
    if (Clock::now() >= deadline) throw ChildFailure(fmt::format("did not end within {:g} s", seconds));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (ended < 0) throw ChildFailure(std::string("was lost: ") + std::strerror(errno));
  return status;
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments) {
  try {
    const SpawnedProcess process = spawn(program, arguments);
    process_ = process.id;
    channel_ = process.channel;
  } catch (const std::runtime_error& error) {
    throw ChildFailure(error.what());
  }
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  close(channel_);
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
  const int status = end_of(process_, deadline, seconds);
  process_ = -1;
  if (status != 0) throw ChildFailure(ending(status), WIFEXITED(status) ? WEXITSTATUS(status) : 0);
  return output;
}

}  // namespace tensegric_fit::geometry
