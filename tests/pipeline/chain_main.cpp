/// The main function of tests in a launched chain.
#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "chain_test");  // rostest gives each its own name
  ros::NodeHandle node;                 // keeps ROS up between clients
  return RUN_ALL_TESTS();
}
