#include "ros/freed_memory.hpp"

#include <jemalloc/jemalloc.h>
#include <malloc.h>

#pragma weak mallctl  // null in programs without jemalloc: rviz, whose plugins must not bring an allocator

#define TEXT_OF(number) #number
#define PURGE_OF(arena) "arena." TEXT_OF(arena) ".purge"

namespace tensegric_fit::node {

void give_back_freed_memory() {
  if (mallctl == nullptr) {
    malloc_trim(0);
    return;
  }
  mallctl("thread.tcache.flush", nullptr, nullptr, nullptr, 0);
  mallctl(PURGE_OF(MALLCTL_ARENAS_ALL), nullptr, nullptr, nullptr, 0);
}

}  // namespace tensegric_fit::node
