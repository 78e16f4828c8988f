#include "virtual_booth/sensor_bag.hpp"

#include "scan_files/cloud_message.hpp"
#include "virtual_booth/sensor_messages.hpp"

namespace tensegric_fit::virtual_booth {

void write_sensor_bag(const std::string& path, const std::vector<SensorScan>& scans,
                      const std::string& frame_id, const ros::Time& stamp) {
  constexpr double kLinger = 2;  // s
  const std::string frames = "sensor_";
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  scan_files::write_latched(bag, "/tf_static", stamp, sensor_poses(scans, frame_id, frames, stamp));
  const ros::Duration apart(0.001);
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    const std::string name = std::to_string(sensor);
    const ros::Time seen = stamp + apart * static_cast<double>(sensor);
    scan_files::write_latched(bag, "/sensors/" + name + "/points", seen,
                              sensor_cloud(scans[sensor], frames + name, seen));
  }
  // rosbag play ends with its last message, and what is still on its way then is lost: no cloud is the last.
  scan_files::write_latched(bag, "/tf_static", stamp + ros::Duration(kLinger),
                            sensor_poses(scans, frame_id, frames, stamp));
}

}  // namespace tensegric_fit::virtual_booth
