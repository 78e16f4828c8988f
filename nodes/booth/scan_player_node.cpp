/// scan_player: publishes the scan of a file on scan/points.
#include <pcl_conversions/pcl_conversions.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>

#include "booth/scan_file.hpp"
#include "geometry/status.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "scan_player");
  ros::NodeHandle node, own("~");

  std::string file;
  if (!own.getParam("file", file)) {
    ROS_FATAL("parameter ~file (the scan: .ply, .pcd or .bag) is not set");
    return 1;
  }
  const std::string frame_id = own.param<std::string>("frame_id", "booth");
  double rate = 0;  // Hz; 0: once
  constexpr double kHighestRate = 1000;
  if ((own.hasParam("rate") && !own.getParam("rate", rate)) || !(rate >= 0 && rate <= kHighestRate)) {
    ROS_FATAL("parameter ~rate must be a number in [0, %g] Hz", kHighestRate);
    return 1;
  }

  sensor_msgs::PointCloud2 scan;
  try {
    pcl::PCLPointCloud2 cloud = tensegric_fit::booth::read_scan(file);
    pcl_conversions::moveFromPCL(cloud, scan);
  } catch (const tensegric_fit::geometry::Refusal& refusal) {
    ROS_FATAL("%s: %s", refusal.code().c_str(), refusal.what());
    return 1;
  }
  scan.header.frame_id = frame_id;

  ros::Publisher publisher = node.advertise<sensor_msgs::PointCloud2>("scan/points", 1, true);
  const auto publish = [&publisher, &scan](const ros::TimerEvent&) {
    scan.header.stamp = ros::Time::now();
    publisher.publish(scan);
  };
  publish({});
  ROS_INFO("%s: %u points on %s", file.c_str(), scan.width * scan.height, publisher.getTopic().c_str());
  ros::Timer timer;
  if (rate > 0) timer = node.createTimer(ros::Duration(1 / rate), publish);
  ros::spin();
  return 0;
}
