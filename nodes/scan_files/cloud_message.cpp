#include "scan_files/cloud_message.hpp"

#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/point_cloud2_iterator.h>

namespace tensegric_fit::scan_files {

sensor_msgs::PointCloud2 cloud_message(const geometry::PointCloud& cloud, const std::string& frame_id,
                                       const ros::Time& stamp) {
  sensor_msgs::PointCloud2 message;
  message.header.frame_id = frame_id;
  message.header.stamp = stamp;
  sensor_msgs::PointCloud2Modifier modifier(message);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(cloud.points.size());
  message.is_dense = true;
  sensor_msgs::PointCloud2Iterator<float> at(message, "x");
  for (const Eigen::Vector3d& p : cloud.points) {
    for (int i = 0; i < 3; ++i) at[i] = static_cast<float>(p[i]);
    ++at;
  }
  return message;
}

pcl::PCLPointCloud2 cloud_in(const sensor_msgs::PointCloud2& message) {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(message, cloud);
  return cloud;
}

}  // namespace tensegric_fit::scan_files
