/// Memory that was freed, back to the system.
#pragma once

#include <chrono>

namespace tensegric_fit::node {

/// Nearly all that this process has freed: of pieces below 32 kB each thread keeps a few. Nodes are linked
/// with jemalloc (tensegric_fit_allocator), since glibc's `malloc_trim`, which is used without it, leaves the
/// free end of every arena but the main one: 156 of 160 MB that four threads had freed.
void give_back_freed_memory();

/// Gives it back when a node has been at rest for a second, longer than a stage waits for the others while
/// scans come one after another: what goes back has to be taken again. Each second from then on, too, since
/// messages that are refused and pictures for who joins later are freed without work. For one thread.
class FreedMemory {
 public:
  /// To be called many times a second.
  void look(bool is_working);

 private:
  std::chrono::steady_clock::time_point since_ =
      std::chrono::steady_clock::now();  // at rest, nothing given back
};

}  // namespace tensegric_fit::node
