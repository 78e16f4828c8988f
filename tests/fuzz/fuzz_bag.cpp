// Bags, as they are checked and as scans are read from them: a bag's bytes, or else what is to be recorded.
#include <dlfcn.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/DeformedMesh.h>
#include <tensegric_fit/FitState.h>
#include <tensegric_fit/TriangleMesh.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <cstring>
#include <limits>

#include "fuzz_target.hpp"
#include "geometry/point_cloud.hpp"
#include "input.hpp"
#include "ros/bag_check.hpp"
#include "scan_files/bag_messages.hpp"
#include "scan_files/scan_bag.hpp"
#include "xyz_cloud.hpp"

namespace {

using namespace tensegric_fit;

constexpr std::array kTopics{"scan/points",      "/left/scan/points", "sensors/0/points",
                             "sensors/1/points", "body/mesh",         "tf"};
constexpr std::array kFrames{"booth", "camera", ""};

/// Messages of the types that a bag is checked for, on topics and at times of any kind.
class Recording {
 public:
  Recording(fuzz::Input& input, const std::string& path) : input_(input), bag_(path, rosbag::bagmode::Write) {
    bag_.setCompression(static_cast<rosbag::CompressionType>(input.number(1) % 3));
    while (!input.at_end()) message();
  }

 private:
  void message() {
    time_ += ros::Duration(input_.number(1) % 8 == 0 ? input_.number(1) : 1);
    switch (input_.number(1) % 8) {
      case 0: {
        tf2_msgs::TFMessage transforms;
        transforms.transforms.resize(1);
        transforms.transforms[0].header.frame_id = frame();
        transforms.transforms[0].child_frame_id = frame();
        return write(transforms);
      }
      case 1:
        return write(std_msgs::String());
      case 2:
        return write_of_scan<TriangleMesh>();
      case 3:
        return write_of_scan<BodyModel>();
      case 4:
        return write_of_scan<FitState>();
      case 5:
        return write_of_scan<DeformedMesh>();
      default:
        write(cloud());
    }
  }

  std::string frame() { return kFrames[input_.number(1) % kFrames.size()]; }

  template <typename Message>
  void write_of_scan() {
    Message message;
    message.scan_id = std::to_string(input_.number(1) % 2);
    write(message);
  }

  template <typename Message>
  void write(const Message& message) {
    bag_.write(kTopics[input_.number(1) % kTopics.size()], time_, message);
  }

  sensor_msgs::PointCloud2 cloud() {
    std_msgs::Header header;
    header.frame_id = frame();
    if (input_.number(1) % 8 != 0) header.stamp = ros::Time(100 + input_.number(1) % 16, 0);
    constexpr std::array<std::uint32_t, 4> kPoints{0, 1, 10, 6000};
    sensor_msgs::PointCloud2 scan = xyz_cloud(kPoints[input_.number(1) % kPoints.size()]);
    scan.header = header;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (std::uint32_t point = scan.width * (input_.number(1) % 4) / 6; point > 0; --point)
      std::memcpy(scan.data.data() + 12 * (point - 1), &kNone, sizeof kNone);
    if (input_.number(1) % 16 == 0) scan.fields.pop_back();
    return scan;
  }

  fuzz::Input& input_;
  rosbag::Bag bag_;
  ros::Time time_{1000, 0};
};

void read(const std::string& path) {
  fuzz::refused_or_done([&] { node::to_text(node::check_bag(path), path); });
  fuzz::refused_or_done([&] { geometry::points_of(scan_files::read_bag_scan(path)); });
  fuzz::refused_or_done([&] { fuzz::require(scan_files::read_bag_scans(path, 2).size() <= 2); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // rosbag loads its encryption plugins for every bag and unloads them after it, which takes longer than all
  // else. Where they lie elsewhere only time is lost.
  [[maybe_unused]] static const void* const kKept =
      dlopen("/usr/${LIB}/ros/librosbag_default_encryption_plugins.so", RTLD_NOW | RTLD_NODELETE);
  const bool recorded = size > 0 && data[0] != '#' && size < 200;
  const fuzz::InputFile file(data, size, ".bag");
  if (recorded) {
    fuzz::Input input(data, size);
    Recording(input, file.path());
  }
  read(file.path());
  return 0;
}
