/// Waiting for what another thread brings.
#pragma once

#include <ros/init.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace tensegric_fit::node {

/// Waits on `changed` until `done()`, for `patience` at most; not while ROS shuts down, when callbacks bring
/// nothing more. Returns `done()`, which is asked under `lock` only.
template <typename Done>
bool await(std::condition_variable& changed, std::unique_lock<std::mutex>& lock,
           std::chrono::duration<double> patience, const Done& done) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kSlice(50);  // nobody says on `changed` that ROS shuts down
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
  while (!done() && !ros::isShuttingDown() && Clock::now() < end)
    changed.wait_until(lock, std::min(end, Clock::now() + kSlice));
  return done();
}

}  // namespace tensegric_fit::node
