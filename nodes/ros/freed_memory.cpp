#include "ros/freed_memory.hpp"

#include <fmt/format.h>
#include <jemalloc/jemalloc.h>
#include <malloc.h>

#pragma weak mallctl  // null in programs without jemalloc: rviz, whose plugins must not bring an allocator

namespace tensegric_fit::node {

void give_back_freed_memory() {
  if (mallctl == nullptr) {
    malloc_trim(0);
    return;
  }
  static const std::string purge = fmt::format("arena.{}.purge", MALLCTL_ARENAS_ALL);
  let_go_of_pieces();
  mallctl(purge.c_str(), nullptr, nullptr, nullptr, 0);
}

void let_go_of_pieces() {
  if (mallctl != nullptr) mallctl("thread.tcache.flush", nullptr, nullptr, nullptr, 0);
}

void FreedMemory::look(bool is_busy, Time now) {
  constexpr std::chrono::seconds kRest(1);
  if (!is_busy && now - since_ < kRest) return;
  if (!is_busy) give_back_freed_memory();
  since_ = now;
}

}  // namespace tensegric_fit::node
