#include "assembler/assembler_handler.hpp"

#include <fmt/format.h>
#include <pcl_conversions/pcl_conversions.h>
#include <tf2/exceptions.h>

#include <boost/make_shared.hpp>
#include <set>

#include "assembler/assembly_message.hpp"
#include "geometry/status.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;
using Fate = assembler::CaptureJoin::Fate;
namespace refusal = geometry::refusal;

constexpr int kMostSensors = 64;

[[noreturn]] void refuse(const std::string& message) {
  throw Refusal(refusal::kBadOption, message);
}

std::vector<std::string> check_topics(std::vector<std::string> topics) {
  const std::set<std::string> different(topics.begin(), topics.end());
  if (topics.empty() || topics.size() > kMostSensors || different.size() != topics.size())
    refuse(fmt::format("parameter 'sensors' must list 1 to {} topics, each once", kMostSensors));
  return topics;
}

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

AssemblerHandler::Setup AssemblerHandler::setup_from(Parameters& parameters) {
  Setup setup;
  setup.sensors = check_topics(parameters.texts("sensors"));
  const int count = static_cast<int>(setup.sensors.size());
  const geometry::Range up_to_all{1, static_cast<double>(count)};
  setup.frame_id = parameters.frame("frame_id", "booth");
  setup.capture.min_sensors = parameters.integer("min_sensors", count, up_to_all);
  setup.capture.slop = parameters.number("slop", setup.capture.slop, geometry::kSlop);
  setup.capture.timeout = parameters.number("timeout", setup.capture.timeout, assembler::kTimeout);
  assembler::AssemblerOptions& assembler = setup.assembler;
  assembler.refine = parameters.flag("refine", assembler.refine);
  assembler.sensors_per_column =
      parameters.integer("sensors_per_column", assembler.sensors_per_column, up_to_all);
  assembler::RegistrationOptions& registration = assembler.registration;
  registration.max_shift = parameters.number("max_shift", registration.max_shift, assembler::kMaxShift);
  registration.max_turn = parameters.number("max_turn", registration.max_turn, assembler::kMaxTurn);
  parameters.check_all_known();
  if (count % assembler.sensors_per_column != 0)
    refuse(fmt::format("parameter 'sensors_per_column' is {}: {} sensors are no whole number of columns",
                       assembler.sensors_per_column, count));
  return setup;
}

AssemblerHandler::AssemblerHandler(Parameters parameters)
    : setup_(setup_from(parameters)), join_(static_cast<int>(setup_.sensors.size()), setup_.capture) {}

void AssemblerHandler::add(int sensor, const sensor_msgs::PointCloud2& message, double now) {
  try {
    constexpr std::uint32_t kSecond = 1000000000;  // ns
    if (message.header.stamp.isZero() || message.header.stamp.nsec >= kSecond)
      throw Refusal(refusal::kNoStamp, "the cloud has no time stamp");
    constexpr std::size_t kMostPoints = 10'000'000;  // a point's 4 bytes may become 52
    if (std::size_t{message.width} * message.height > kMostPoints)
      throw Refusal(refusal::kTooManyPoints, fmt::format("the cloud has {} x {} points, more than 10 million",
                                                         message.width, message.height));
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
  const std::vector<assembler::SharedFrame> shared = assembler::shared_frames(capture, setup_.frame_id);
  const assembler::Assembly assembly =
      assembler::assemble(capture, booth_from_sensor, setup_.assembler, shared);
  std_msgs::Header header;
  header.stamp = time_of(capture.first);
  header.frame_id = setup_.frame_id;
  Output output;
  output.warning = assembler::warning_of(shared, setup_.sensors);
  output.scan = boost::make_shared<sensor_msgs::PointCloud2>(to_message(header, assembly));
  output.facts = {{"scan", tag_of(*output.scan).scan_id}, {"points", std::to_string(output.scan->width)}};
  if (const auto& registration = assembly.registration) {
    output.facts.emplace_back("registration", to_string(registration->status));
    output.facts.emplace_back("overlap_mm_before",
                              fmt::format("{:.3f}", 1000 * registration->residual_before));
    output.facts.emplace_back("overlap_mm_after", fmt::format("{:.3f}", 1000 * registration->residual_after));
    if (registration->status == assembler::RegistrationStatus::too_far)
      output.warning += (output.warning.empty() ? "" : "; ") + off_calibration(*registration);
  }
  return output;
}

std::string AssemblerHandler::off_calibration(const assembler::Registration& registration) const {
  const int per_column = setup_.assembler.sensors_per_column;
  const auto first = setup_.sensors.begin() + std::ptrdiff_t{registration.farthest} * per_column;
  return fmt::format(
      "column {} ({}) seems to stand {:.0f} mm and {:.1f} degrees off its calibration: calibrate "
      "the booth again",
      registration.farthest + 1, fmt::join(first, first + per_column, ", "),
      1000 * registration.farthest_shift, 180 / M_PI * registration.farthest_turn);
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
