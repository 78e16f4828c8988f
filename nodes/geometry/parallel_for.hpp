/// Work on two threads, with results that do not depend on when either runs.
#pragma once

#include <cstddef>
#include <future>

namespace tensegric_fit::geometry {

/// Calls `work(begin, end, half)` for the first half of [0, count) on a second thread and for the other on
/// this one: the same two halves on every machine. What either throws is thrown here. \pre the halves write
/// to different places
template <typename Work>
void parallel_for(std::size_t count, const Work& work) {
  const std::size_t middle = count / 2;
  auto first = std::async(std::launch::async, [&work, middle] { work(std::size_t{0}, middle, 0); });
  work(middle, count, 1);
  first.get();
}

}  // namespace tensegric_fit::geometry
