/// Workers (worker.hpp) and their limits: what crashes or hangs takes one scan with it, not the batch.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "geometry/spawned_process.hpp"

namespace tensegric_fit::batch {

struct WorkerLimits {
  double seconds = 300;                      ///< of the clock per scan
  std::size_t bytes = std::size_t{6} << 30;  ///< of address space per worker
};

/// What became of a job: a worker's line, or one in its place with status `crashed` or `timed_out`.
struct Finished {
  std::size_t job = 0;          ///< as it was given
  nlohmann::ordered_json line;  ///< null: its worker was interrupted, which says nothing of the job
};

class WorkerPool {
 public:
  /// Workers start with their first job. \pre workers > 0
  WorkerPool(int workers, const WorkerLimits& limits);
  /// Kills them.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  bool has_idle() const;
  bool is_busy() const;
  /// \pre has_idle() \throw std::runtime_error: no worker can be started
  void give(std::size_t job, const std::vector<std::string>& arguments);
  /// What has finished, after `patience` at the latest, sooner where a signal comes.
  std::vector<Finished> wait(std::chrono::milliseconds patience);

 private:
  struct Worker {
    geometry::SpawnedProcess process;
    bool busy = false;
    std::size_t job = 0;
    std::chrono::steady_clock::time_point started;
    std::string received;
  };

  void start(Worker& worker) const;
  static int stop(Worker& worker);
  std::optional<Finished> receive(Worker& worker) const;
  Finished lost(Worker& worker, const char* status, const std::string& message) const;

  WorkerLimits limits_;
  std::vector<Worker> workers_;
};

}  // namespace tensegric_fit::batch
