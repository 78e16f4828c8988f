/// A node that is sent a message of a few bytes which says that it has billions of numbers.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

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

}  // namespace
}  // namespace tensegric_fit::node
