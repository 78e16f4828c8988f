// With the allocator of the stages' programs.
#include "ros/freed_memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <future>
#include <thread>
#include <vector>

#include "../peak_memory.hpp"

namespace tensegric_fit::node {
namespace {

double anonymous_mebibytes() {
  return gauge::status_mebibytes("RssAnon");
}

// Threads outlive what they freed, as a node's do. With glibc's malloc_trim their arenas' free ends stayed,
// once a large piece had been freed, which raises what it keeps.
TEST(FreedMemory, GoesBackWholeWhateverThreadTookIt) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what is freed, to see whether it is used";
#endif
  constexpr int kThreads = 4, kPieces = 20000;
  constexpr std::size_t kBytes = 2000;  // of a piece: 40 MB a thread
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  std::vector<std::thread> threads;
  std::array<std::promise<void>, kThreads> freed;
  constexpr std::size_t kLarge = 30000000;
  const auto work = [&](int thread) {
    { const std::vector<char> large(kLarge, 1); }
    {
      std::vector<std::vector<char>> pieces;
      for (int i = 0; i < kPieces; ++i) pieces.emplace_back(kBytes, static_cast<char>(i));
    }
    freed[thread].set_value();
    ended.wait();
  };
  give_back_freed_memory();
  const double before = anonymous_mebibytes();
  for (int thread = 0; thread < kThreads; ++thread) threads.emplace_back(work, thread);
  for (std::promise<void>& done : freed) done.get_future().wait();
  const double kept = anonymous_mebibytes() - before;
  give_back_freed_memory();
  const double after = anonymous_mebibytes() - before;
  end.set_value();
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(kept, 40) << "the allocator keeps what is freed while there is work";
  // MiB: stacks, small pieces that each thread keeps, jemalloc's own tables; 6 here, 156 by malloc_trim.
  EXPECT_LT(after, 12);
}

TEST(FreedMemory, GoesBackAfterASecondWithoutWork) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers keep what is freed, to see whether it is used";
#endif
  constexpr std::chrono::milliseconds kTick(100);
  FreedMemory memory;
  FreedMemory::Time now{};
  const auto ticks_until_given_back = [&](bool is_busy) {
    {
      std::vector<std::vector<char>> pieces;
      for (int i = 0; i < 20000; ++i) pieces.emplace_back(2000, static_cast<char>(i));
    }
    const double kept = anonymous_mebibytes();
    for (int ticks = 1; ticks <= 30; ++ticks) {
      memory.look(is_busy, now += kTick);
      if (anonymous_mebibytes() < kept - 20) return ticks;
    }
    return 0;
  };
  EXPECT_EQ(ticks_until_given_back(true), 0);
  EXPECT_EQ(ticks_until_given_back(false), 10);
  EXPECT_EQ(ticks_until_given_back(false), 10) << "what is freed without work goes back, too";
}

}  // namespace
}  // namespace tensegric_fit::node
