/// Waits that end with what was waited for, with patience, or with ROS.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <unistd.h>

#include <thread>

#include "ros/await.hpp"

namespace tensegric_fit::node {
namespace {

/// Whether what nobody changes is there after `seconds` at most.
bool is_there_after(double seconds, bool is_there) {
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_lock<std::mutex> lock(mutex);
  return await(changed, lock, std::chrono::duration<double>(seconds), [&] { return is_there; });
}

/// In a process of its own: ROS begins once.
void wait_while_ros_shuts_down() {
  alarm(20);
  ros::init(ros::M_string{{"__master", "http://localhost:1"}}, "await_test", ros::init_options::NoRosout);
  std::thread([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ros::shutdown();
  }).detach();
  _exit(is_there_after(60, false) ? 1 : 0);
}

TEST(Await, EndsWithWhatAnotherThreadBrings) {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_there = false;
  std::unique_lock<std::mutex> lock(mutex);
  std::thread bringer([&] {
    const std::lock_guard<std::mutex> own(mutex);
    is_there = true;
    changed.notify_all();
  });
  EXPECT_TRUE(await(changed, lock, std::chrono::minutes(1), [&] { return is_there; }));
  lock.unlock();
  bringer.join();
}

TEST(Await, EndsWithPatience) {
  EXPECT_FALSE(is_there_after(0.01, false));
  EXPECT_TRUE(is_there_after(0, true));
}

/// Once it took all of its patience, and the node as long to end.
TEST(Await, EndsWhenRosShutsDown) {
  EXPECT_EXIT(wait_while_ros_shuts_down(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace tensegric_fit::node
