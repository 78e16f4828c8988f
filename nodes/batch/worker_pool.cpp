#include "batch/worker_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>

namespace tensegric_fit::batch {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::size_t kBlock = std::size_t{1} << 16;  // bytes read at once

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Who ends a batch, by Ctrl-C or as Slurm does, may end its workers first.
bool is_interruption(int wait_status) {
  return WIFSIGNALED(wait_status) && (WTERMSIG(wait_status) == SIGINT || WTERMSIG(wait_status) == SIGTERM);
}

}  // namespace

WorkerPool::WorkerPool(int workers, const WorkerLimits& limits)
    : limits_(limits), workers_(static_cast<std::size_t>(workers)) {}

WorkerPool::~WorkerPool() {
  for (Worker& worker : workers_)
    if (worker.process.id > 0) stop(worker);
}

void WorkerPool::start(Worker& worker) const {
  worker.process =
      geometry::spawn(geometry::sibling_program("fit_batch"), {"worker", std::to_string(limits_.bytes)});
}

/// Kills it where it still runs; waitpid's status.
int WorkerPool::stop(Worker& worker) {
  kill(worker.process.id, SIGKILL);
  close(worker.process.channel);
  const int status = geometry::wait_for(worker.process.id);
  worker = Worker();
  return status;
}

bool WorkerPool::has_idle() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.busy; });
}

bool WorkerPool::is_busy() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return w.busy; });
}

void WorkerPool::give(std::size_t job, const std::vector<std::string>& arguments) {
  Worker& worker = *std::find_if(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.busy; });
  const std::string request = Json{{"arguments", arguments}}.dump() + "\n";
  for (int attempt = 0; attempt < 2; ++attempt) {  // one that was killed while idle is replaced
    if (worker.process.id < 0) start(worker);
    const ssize_t sent = send(worker.process.channel, request.data(), request.size(), MSG_NOSIGNAL);
    if (sent == static_cast<ssize_t>(request.size())) break;
    stop(worker);
  }
  if (worker.process.id < 0) throw std::runtime_error("workers take no job");
  worker.busy = true;
  worker.job = job;
  worker.started = Clock::now();
}

std::vector<Finished> WorkerPool::wait(std::chrono::milliseconds patience) {
  std::vector<pollfd> channels;
  std::vector<Worker*> busy;
  for (Worker& worker : workers_) {
    if (!worker.busy) continue;
    channels.push_back({worker.process.channel, POLLIN, 0});
    busy.push_back(&worker);
    const auto left = std::chrono::duration<double>(limits_.seconds - seconds_since(worker.started));
    patience = std::min(patience, std::chrono::duration_cast<std::chrono::milliseconds>(left));
  }
  patience = std::max(patience, std::chrono::milliseconds(0));
  poll(channels.data(), channels.size(), static_cast<int>(patience.count()));
  std::vector<Finished> all;
  for (std::size_t i = 0; i < busy.size(); ++i) {
    std::optional<Finished> finished;
    if (channels[i].revents != 0) finished = receive(*busy[i]);
    if (finished)
      all.push_back(std::move(*finished));
    else if (busy[i]->busy && seconds_since(busy[i]->started) >= limits_.seconds)
      all.push_back(lost(*busy[i], "timed_out", fmt::format("took more than {:g} s", limits_.seconds)));
  }
  return all;
}

/// None where no job is finished by it.
std::optional<Finished> WorkerPool::receive(Worker& worker) const {
  std::array<char, kBlock> block;
  const ssize_t n = recv(worker.process.channel, block.data(), block.size(), MSG_DONTWAIT);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return std::nullopt;
  if (n <= 0) return lost(worker, "crashed", "");
  worker.received.append(block.data(), static_cast<std::size_t>(n));
  if (worker.received.back() != '\n') return std::nullopt;
  Finished finished{worker.job, Json::parse(worker.received)};
  worker.received.clear();
  worker.busy = false;
  if (finished.line.value("status", "") == "out_of_memory") stop(worker);  // it ends, and takes no other job
  return finished;
}

/// Without a message: how the worker ended.
Finished WorkerPool::lost(Worker& worker, const char* status, const std::string& message) const {
  Finished finished{worker.job, {}};
  const double seconds = seconds_since(worker.started);
  const int ended = stop(worker);
  if (is_interruption(ended)) return finished;
  finished.line = {
      {"status", status},
      {"reason",
       {{"code", status}, {"message", message.empty() ? "the worker " + geometry::ending(ended) : message}}},
      {"cost", {{"seconds", seconds}}}};
  return finished;
}

}  // namespace tensegric_fit::batch
