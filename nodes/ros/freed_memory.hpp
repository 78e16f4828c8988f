/// Memory that was freed, back to the system.
#pragma once

#include <chrono>

namespace tensegric_fit::node {

/// Nearly all that this process has freed; of pieces below 32 kB each thread keeps some, unless it lets go of
/// them (let_go_of_pieces). Nodes are linked with jemalloc (tensegric_fit_allocator), since glibc's
/// `malloc_trim`, which is used without it, leaves the free end of every arena but the main one: 156 of 160
/// MB that four threads had freed.
void give_back_freed_memory();

/// The small pieces that this thread keeps. For threads that wait for work.
void let_go_of_pieces();

/// When a node gives freed memory back: after a second without work, so that a node which scans keep busy
/// does not take the same memory again and again; then each second, since messages that are refused and
/// pictures for who joins later are freed without work. For one thread.
class FreedMemory {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// To be called many times a second.
  void look(bool is_busy, Time now);

 private:
  Time since_;  // at rest, nothing given back
};

}  // namespace tensegric_fit::node
