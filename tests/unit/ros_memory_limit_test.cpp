/// A node that is sent a message of a few bytes which says that it has billions of numbers.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <future>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "ros/freed_memory.hpp"
#include "ros/memory_limit.hpp"

namespace tensegric_fit::node {
namespace {

// As roscpp makes room for an array of a message, before it looks whether its bytes came. The room is not
// used: where it is there, this must not take the machine's memory.
bool has_room_for(std::size_t bytes) {
  void* room = std::malloc(bytes);
  const volatile bool is_there = room != nullptr;
  std::free(room);
  return is_there;
}

TEST(MemoryLimit, NoRoomIsMadeForMoreThanHalfOfTheMachinesMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take terabytes of address space";
#endif
  const auto memory = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  EXPECT_EXIT(
      {
        limit_memory();
        std::_Exit(!has_room_for(memory / 10 * 6) && has_room_for(1 << 24) ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

// jemalloc keeps what was given back mapped by default, of each thread for itself: it counts still.
TEST(MemoryLimit, WhatOneThreadFreedAnotherCanHaveOnceItWasGivenBack) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take terabytes of address space";
#endif
  const auto takes_and_frees = [] {
    constexpr int kPieces = 500;
    std::vector<std::unique_ptr<char[]>> pieces;
    for (int i = 0; i < kPieces; ++i) {
      pieces.emplace_back(new (std::nothrow) char[1 << 20]);
      if (!pieces.back()) std::_Exit(1);
    }
  };
  EXPECT_EXIT(
      {
        rlimit limit{};
        limit.rlim_cur = limit.rlim_max = 800 << 20;
        setrlimit(RLIMIT_DATA, &limit);
        for (int i = 0; i < 3; ++i) {
          std::promise<void> freed;
          std::thread([&] {
            takes_and_frees();
            freed.set_value();
            pause();  // threads that live have arenas of their own
          }).detach();
          freed.get_future().wait();
          give_back_freed_memory();
        }
        std::_Exit(0);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tensegric_fit::node
