/// Lengths that lie are found before room is made for what they promise.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/Garment.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <filesystem>

#include "files/message_layout.hpp"
#include "geometry/status.hpp"
#include "ros/bag_check.hpp"

namespace tensegric_fit::files {
namespace {

template <typename Message>
std::string serialized(const Message& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
bool holds(const std::string& bytes) {
  try {
    MessageLayout(ros::message_traits::definition<Message>()).check(bytes);
    return true;
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "broken_file");
    return false;
  }
}

/// Each message that is cut off anywhere, and each of its four bytes as the largest number.
template <typename Message>
void check_lies(const Message& message) {
  const std::string sound = serialized(message);
  EXPECT_TRUE(holds<Message>(sound));
  for (std::size_t size = 0; size < sound.size(); ++size)
    EXPECT_FALSE(holds<Message>(sound.substr(0, size))) << size;
  for (std::size_t at = 0; at + 4 <= sound.size(); ++at) {
    std::string lie = sound;
    lie.replace(at, 4, "\xff\xff\xff\xff");
    if (!holds<Message>(lie)) continue;  // else it is no length: roscpp reads it
    Message read;
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(lie.data()),
                                       static_cast<std::uint32_t>(lie.size()));
    EXPECT_NO_THROW(ros::serialization::deserialize(stream, read)) << at;
  }
}

TEST(MessageLayout, EveryLengthOfEveryKindOfMessageIsLookedAt) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "booth";
  cloud.fields.resize(2);
  cloud.fields[1].name = "x";
  cloud.data = {1, 2, 3};
  check_lies(cloud);
  Garment garment;
  garment.name = "band";
  garment.regions = {"bust", ""};
  garment.lines.resize(2);
  garment.lines[1].law = GarmentLine::TABLE;  // a constant of its definition
  garment.lines[1].through = {"a", "b"};
  garment.lines[1].stretch = {1, 2};
  check_lies(garment);
  BodyModel model;  // arrays of a fixed length
  model.turns = {1, 2, 3};
  model.parts = {"head"};
  check_lies(model);
  tf2_msgs::TFMessage transforms;  // parts of other packages
  transforms.transforms.resize(2);
  check_lies(transforms);
}

TEST(MessageLayout, ABagWhoseCloudAsksForAllMemoryIsBroken) {
  const std::string path =
      std::filesystem::temp_directory_path() / ("message_layout_" + std::to_string(getpid()) + ".bag");
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.write("scan/points", ros::Time(5), sensor_msgs::PointCloud2());
    std_msgs::String lie;  // which rosbag takes for a cloud, as the topic's first message was one
    lie.data = std::string(20, '\0') + "\xff\xff\xff\xff";  // stamp, frame, height, width, number of fields
    bag.write("scan/points", ros::Time(6), lie);
  }
  const node::BagCheck check = node::check_bag(path);
  std::filesystem::remove(path);
  ASSERT_EQ(check.findings.size(), 1u);
  EXPECT_EQ(check.findings[0].name, "broken_bag");
  EXPECT_NE(check.findings[0].what.find("shorter than its lengths say"), std::string::npos)
      << check.findings[0].what;
}

}  // namespace
}  // namespace tensegric_fit::files
