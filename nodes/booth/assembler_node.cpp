/// Clouds of a booth's sensors -> scan/points
#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/transform_listener.h>

#include "booth/assembler_setup.hpp"
#include "booth/assembly_message.hpp"
#include "ros/run_node.hpp"
#include "ros/scan_tag.hpp"
#include "ros/stage.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

Eigen::Isometry3d isometry(const geometry_msgs::Transform& transform) {
  const auto& [shift, turn] = std::tie(transform.translation, transform.rotation);
  return Eigen::Translation3d(shift.x, shift.y, shift.z) *
         Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized();
}

ros::Time time_of(std::uint64_t stamp) {
  ros::Time time;
  time.fromNSec(stamp);
  return time;
}

/// Before it is assembled, a scan is known by its stamp.
std::string id_of(std::uint64_t stamp) {
  return fmt::format("{}.{:09}", stamp / 1000000000, stamp % 1000000000);
}

class AssemblerNode {
 public:
  AssemblerNode(ros::NodeHandle node, const ros::NodeHandle& private_node)
      : setup_(assembler_setup(Parameters(private_node))),
        join_(static_cast<int>(setup_.sensors.size()), setup_.capture),
        listener_(transforms_),
        scan_(node.advertise<sensor_msgs::PointCloud2>("scan/points", 1, true)),
        stage_("assembler", node) {
    constexpr int kQueue = 4;
    for (std::size_t sensor = 0; sensor < setup_.sensors.size(); ++sensor)
      sensors_.push_back(node.subscribe<sensor_msgs::PointCloud2>(
          setup_.sensors[sensor], kQueue, [this, sensor](const sensor_msgs::PointCloud2::ConstPtr& cloud) {
            on_cloud(static_cast<int>(sensor), *cloud);
          }));
    clock_ = node.createWallTimer(ros::WallDuration(std::min(0.05, setup_.capture.timeout / 4)),
                                  [this](const ros::WallTimerEvent&) { hand_on(); });
  }

 private:
  void on_cloud(int sensor, const sensor_msgs::PointCloud2& message) {
    const std::string scan_id = id_of(message.header.stamp.toNSec());
    try {
      if (message.header.stamp.isZero())
        throw Refusal(refusal::kNoStamp, "the cloud says not when it was seen");
      pcl::PCLPointCloud2 cloud;
      pcl_conversions::toPCL(message, cloud);
      const auto seen = std::make_shared<const booth::SensorCloud>(booth::SensorCloud{
          message.header.stamp.toNSec(), message.header.frame_id, geometry::points_of(cloud)});
      if (join_.add(sensor, seen, ros::SteadyTime::now().toSec()) == booth::CaptureJoin::Fate::late)
        throw Refusal(refusal::kLateCloud, "the cloud came after its capture, or a newer one, had left");
    } catch (const Refusal& refused) {
      stage_.drop(scan_id, Refusal(refused.code(), setup_.sensors[sensor] + ": " + refused.what()));
    }
    hand_on();
  }

  void hand_on() {
    while (const std::optional<booth::Capture> capture = join_.next(ros::SteadyTime::now().toSec())) {
      const std::string scan_id = id_of(capture->first);
      std::vector<std::string> missing;
      for (int sensor : capture->missing()) missing.push_back(setup_.sensors[sensor]);
      const std::size_t came = setup_.sensors.size() - missing.size();
      const std::string warning = missing.empty()
                                      ? ""
                                      : fmt::format("{} of {} sensors came in time; missing: {}", came,
                                                    setup_.sensors.size(), fmt::join(missing, ", "));
      if (static_cast<int>(came) < setup_.min_sensors) {
        stage_.refuse(scan_id, Refusal(refusal::kMissingSensor, warning));
        continue;
      }
      stage_.begin(scan_id);
      stage_.post(scan_id, [this, capture, warning] { return assemble(*capture, warning); });
    }
  }

  Stage::Result assemble(const booth::Capture& capture, const std::string& warning) {
    std::vector<Eigen::Isometry3d> booth_from_sensor(capture.clouds.size());
    for (std::size_t sensor = 0; sensor < capture.clouds.size(); ++sensor)
      if (capture.clouds[sensor])
        booth_from_sensor[sensor] = pose_of(*capture.clouds[sensor], setup_.sensors[sensor]);
    const booth::Assembly assembly = booth::assemble(capture, booth_from_sensor, setup_.assembler);
    std_msgs::Header header;
    header.stamp = time_of(capture.first);
    header.frame_id = setup_.frame_id;
    const sensor_msgs::PointCloud2 message = to_message(header, assembly);
    Stage::Facts facts = {{"scan", tag_of(message).scan_id}, {"points", std::to_string(message.width)}};
    if (const auto& registration = assembly.registration) {
      facts.emplace_back("registration", to_string(registration->status));
      facts.emplace_back("overlap_mm_before", fmt::format("{:.3f}", 1000 * registration->residual_before));
      facts.emplace_back("overlap_mm_after", fmt::format("{:.3f}", 1000 * registration->residual_after));
    }
    return {[this, message] { scan_.publish(message); }, facts, warning};
  }

  /// Waits for tf, which can come after the clouds, by the wall's clock: a recording's can stand still.
  Eigen::Isometry3d pose_of(const booth::SensorCloud& cloud, const std::string& sensor) const {
    const ros::Time stamp = time_of(cloud.stamp);
    const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(setup_.capture.timeout);
    while (!transforms_.canTransform(setup_.frame_id, cloud.frame_id, stamp) && ros::WallTime::now() < end)
      ros::WallDuration(0.01).sleep();
    try {
      return isometry(transforms_.lookupTransform(setup_.frame_id, cloud.frame_id, stamp).transform);
    } catch (const tf2::TransformException& error) {
      throw Refusal(refusal::kNoTransform, sensor + ": " + error.what());
    }
  }

  const AssemblerSetup setup_;
  booth::CaptureJoin join_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener listener_;
  ros::Publisher scan_;
  std::vector<ros::Subscriber> sensors_;
  ros::WallTimer clock_;
  Stage stage_;  // last: its worker uses all of the above
};

}  // namespace
}  // namespace tensegric_fit::node

int main(int argc, char** argv) {
  return tensegric_fit::node::run_node<tensegric_fit::node::AssemblerNode>(argc, argv, "assembler");
}
