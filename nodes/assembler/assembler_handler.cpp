#include "assembler/assembler_handler.hpp"

#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <tf2/exceptions.h>

#include <boost/make_shared.hpp>

#include "assembler/assembly_message.hpp"
#include "geometry/status.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
using Fate = assembler::CaptureJoin::Fate;
namespace refusal = geometry::refusal;

Eigen::Isometry3d isometry(const geometry_msgs::Transform& transform) {
  const auto& [shift, turn] = std::tie(transform.translation, transform.rotation);
  return Eigen::Translation3d(shift.x, shift.y, shift.z) *
         Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized();
}

}  // namespace

ros::Time time_of(std::uint64_t stamp) {
  ros::Time time;
  time.fromNSec(stamp);
  return time;
}

AssemblerHandler::AssemblerHandler(Parameters parameters)
    : setup_(assembler_setup(std::move(parameters))),
      join_(static_cast<int>(setup_.sensors.size()), setup_.capture) {}

void AssemblerHandler::add(int sensor, const sensor_msgs::PointCloud2& message, double now) {
  try {
    if (message.header.stamp.isZero())
      throw Refusal(refusal::kNoStamp, "the cloud says not when it was seen");
    pcl::PCLPointCloud2 cloud;
    pcl_conversions::toPCL(message, cloud);
    const auto seen = std::make_shared<const assembler::SensorCloud>(assembler::SensorCloud{
        message.header.stamp.toNSec(), message.header.frame_id, geometry::points_of(cloud)});
    const Fate fate = join_.add(sensor, seen, now);
    if (fate == Fate::late)
      throw Refusal(refusal::kLateCloud, "the cloud came after its capture, or a newer one, had left");
    if (fate == Fate::played)
      throw Refusal(refusal::kLateCloud,
                    "a scan was made of this cloud already; to play a recording again, start the assembler "
                    "again");
  } catch (const Refusal& refused) {
    throw Refusal(refused.code(), setup_.sensors[sensor] + ": " + refused.what());
  }
}

AssemblerHandler::Output AssemblerHandler::handle(const assembler::Capture& capture,
                                                  const tf2::BufferCore& transforms) const {
  std::vector<Eigen::Isometry3d> booth_from_sensor(capture.clouds.size());
  for (std::size_t sensor = 0; sensor < capture.clouds.size(); ++sensor)
    if (capture.clouds[sensor])
      booth_from_sensor[sensor] = pose_of(static_cast<int>(sensor), *capture.clouds[sensor], transforms);
  const assembler::Assembly assembly = assembler::assemble(capture, booth_from_sensor, setup_.assembler);
  std_msgs::Header header;
  header.stamp = time_of(capture.first);
  header.frame_id = setup_.frame_id;
  Output output;
  output.scan = boost::make_shared<sensor_msgs::PointCloud2>(to_message(header, assembly));
  output.facts = {{"scan", tag_of(*output.scan).scan_id}, {"points", std::to_string(output.scan->width)}};
  if (const auto& registration = assembly.registration) {
    output.facts.emplace_back("registration", to_string(registration->status));
    output.facts.emplace_back("overlap_mm_before",
                              fmt::format("{:.3f}", 1000 * registration->residual_before));
    output.facts.emplace_back("overlap_mm_after", fmt::format("{:.3f}", 1000 * registration->residual_after));
  }
  return output;
}

Eigen::Isometry3d AssemblerHandler::pose_of(int sensor, const assembler::SensorCloud& cloud,
                                            const tf2::BufferCore& transforms) const {
  try {
    return isometry(
        transforms.lookupTransform(setup_.frame_id, cloud.frame_id, time_of(cloud.stamp)).transform);
  } catch (const tf2::TransformException& error) {
    throw Refusal(refusal::kNoTransform, setup_.sensors[sensor] + ": " + error.what());
  }
}

}  // namespace tensegric_fit::node
