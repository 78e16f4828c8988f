// What a booth's sensors send: clouds, which the assembler joins, depth images, and scans as a booth
// assembled them itself. The first byte chooses which.
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "assembler/assembler_handler.hpp"
#include "depth_cameras/camera_message.hpp"
#include "fuzz_target.hpp"
#include "input.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "xyz_cloud.hpp"

namespace {

using namespace tensegric_fit;
using namespace tensegric_fit::node;

/// A sheet of points, some of them drawn, and a message that may not be as it says.
sensor_msgs::PointCloud2 cloud(fuzz::Input& input) {
  sensor_msgs::PointCloud2 message = xyz_cloud(256);  // two of them can be moved onto each other
  for (std::uint32_t i = 0; i < message.width; ++i) {
    const auto column = static_cast<float>(i % 16), row = static_cast<float>(i / 16);
    const std::array<float, 3> place{0.005F * column, 0.005F * row, 1 + 0.0005F * column * row};
    std::memcpy(&message.data[i * message.point_step], place.data(), sizeof place);
  }
  for (std::uint32_t drawn = input.number(1) % 8; drawn > 0; --drawn) {
    const auto number = static_cast<float>(input.real());
    const std::uint32_t point = input.number(1) % message.width, axis = input.number(1) % 3;
    std::memcpy(&message.data[point * message.point_step + axis * sizeof number], &number, sizeof number);
  }
  fuzz::draw_some(input, message.width, message.height, message.point_step, message.row_step);
  fuzz::change(input, message.fields);
  for (sensor_msgs::PointField& field : message.fields)
    fuzz::draw_some(input, field.offset, field.datatype, field.count);
  message.header.stamp = ros::Time(input.number(1) % 8, 0);  // none, too
  constexpr std::array kFrames{"left", "right", "booth", "", "elsewhere"};
  message.header.frame_id = kFrames[input.number(1) % kFrames.size()];
  return message;
}

/// Where sensors stand, as tf says it: anything that it takes.
void stand(fuzz::Input& input, tf2::BufferCore& transforms) {
  for (const char* sensor : {"left", "right"}) {
    geometry_msgs::TransformStamped pose;
    pose.header.frame_id = "booth";
    pose.child_frame_id = sensor;
    pose.transform.rotation.w = 1;
    auto& [shift, turn] = pose.transform;
    shift.z = 1e-4 * static_cast<double>(input.number(1));
    fuzz::draw_some(input, shift.x, shift.y, shift.z, turn.x, turn.y, turn.z, turn.w);
    transforms.setTransform(pose, "fuzzer", input.number(1) % 4 != 0);
  }
}

void join_clouds(fuzz::Input& input) {
  AssemblerHandler stage(
      Parameters(YAML::Load("{sensors: [left, right], min_sensors: 1, slop: 0.1, timeout: 1}"), "assembler"));
  tf2::BufferCore transforms;
  stand(input, transforms);
  double now = 0;
  while (!input.at_end()) {
    const int sensor = static_cast<int>(input.number(1) % 2);
    fuzz::refused_or_done([&] { stage.add(sensor, cloud(input), now); });
    now += input.number(1) / 64.0;
    while (const std::optional<assembler::Capture> capture = stage.next(now))
      fuzz::refused_or_done([&] {
        const AssemblerHandler::Output output = stage.handle(*capture, transforms);
        fuzz::require(output.scan->width > 0 &&
                      output.scan->data.size() == std::size_t{output.scan->width} * output.scan->point_step);
        for (sensor_msgs::PointCloud2ConstIterator<float> x(*output.scan, "x"); x != x.end(); ++x)
          fuzz::require(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]));
      });
  }
}

void take_depths(fuzz::Input& input) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(1, 0);
  image.encoding = input.number(1) % 2 == 0 ? "16UC1" : "32FC1";
  image.width = 1 + input.number(1) % 16;
  image.height = 1 + input.number(1) % 16;
  image.step = image.width * (image.encoding == "16UC1" ? 2 : 4);
  image.data.assign(std::size_t{image.step} * image.height, 63);
  sensor_msgs::CameraInfo info;
  info.width = image.width;
  info.height = image.height;
  info.K = {20, 0, 8, 0, 20, 8, 0, 0, 1};
  info.P = {20, 0, 8, 0, 0, 20, 8, 0, 0, 0, 1, 0};
  constexpr std::array kModels{"plumb_bob", "rational_polynomial", "fisheye", ""};
  info.distortion_model = kModels[input.number(1) % kModels.size()];
  constexpr std::array<std::size_t, 6> kNumbers{0, 4, 5, 8, 12, 14};
  info.D.assign(kNumbers[input.number(1) % kNumbers.size()], 0);
  for (double& number : info.D) fuzz::draw_some(input, number);
  for (double& number : info.K) fuzz::draw_some(input, number);
  for (double& number : info.P) fuzz::draw_some(input, number);
  fuzz::draw_some(input, info.R[4], image.width, image.height, image.step, image.is_bigendian, info.width,
                  info.binning_x, info.roi.x_offset);
  fuzz::change(input, info.D);
  fuzz::change(input, image.data);
  if (input.number(1) % 16 == 0) image.header.stamp = ros::Time();
  check_depth_image(image, info);
  fuzz::require(rectified(image, info).data.size() >= std::size_t{image.width} * image.height);
}

/// Too little to be a body, whatever it is: nothing of it may get to the surface.
void reconstruct_scan(fuzz::Input& input) {
  static const ReconstructionHandler stage(Parameters(YAML::Load("{min_points: 500}"), "reconstruction"));
  const sensor_msgs::PointCloud2 scan = cloud(input);
  lacks_of(scan.header, {"left", "right"});
  try {
    stage.handle(scan, tag_of(scan));
  } catch (const geometry::Refusal&) {
    return;
  }
  fuzz::require(false);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto take = std::array{join_clouds, take_depths, reconstruct_scan}[input.number(1) % 3];
  fuzz::refused_or_done([&] { take(input); });
  return 0;
}
