/// What is wrong with a bag is said by name.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <std_msgs/String.h>
#include <tensegric_fit/BodyModel.h>
#include <tensegric_fit/Garment.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "ros/bag_check.hpp"
#include "ros/body_messages.hpp"
#include "tensegric/fit_messages.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;

sensor_msgs::PointCloud2 scan_at(double stamp, std::size_t points = 6000, std::size_t not_finite = 0) {
  sensor_msgs::PointCloud2 scan;
  scan.header.stamp = ros::Time(stamp);
  scan.header.frame_id = "booth";
  sensor_msgs::PointCloud2Modifier modifier(scan);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(points);
  sensor_msgs::PointCloud2Iterator<float> x(scan, "x");
  for (std::size_t i = 0; i < points; ++i, ++x)
    for (int axis = 0; axis < 3; ++axis) x[axis] = i < not_finite ? NAN : 0.001f * static_cast<float>(i);
  return scan;
}

class CheckBagTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// Names of what is found in a bag that `write` fills, those that hinder first.
  template <typename Write>
  std::vector<std::string> found_in(const Write& write) {
    {
      rosbag::Bag bag(path_, rosbag::bagmode::Write);
      write(bag);
    }
    return found();
  }
  std::vector<std::string> found() {
    check_ = check_bag(path_);
    std::vector<std::string> names;
    for (const BagFinding& finding : check_.findings) {
      EXPECT_NE(to_text(check_, path_).find(finding.advice), std::string::npos);
      names.push_back((finding.hinders ? "" : "note ") + finding.name);
    }
    EXPECT_EQ(check_.can_be_replayed(), std::count_if(names.begin(), names.end(), [](const auto& name) {
                                          return name.compare(0, 5, "note ") != 0;
                                        }) == 0);
    return names;
  }

  using Names = std::vector<std::string>;
  const fs::path folder_ = fs::temp_directory_path() / ("check_bag_test." + std::to_string(getpid()));
  const std::string path_ = folder_ / "scan.bag";
  BagCheck check_;
};

void write_scan(rosbag::Bag& bag, double time, const sensor_msgs::PointCloud2& scan,
                const std::string& topic = "/scan/points") {
  bag.write(topic, ros::Time(time), scan);
}

TEST_F(CheckBagTest, TwoBoothsInOneBagAreNamed) {
  const auto fill = [](const std::string& second_scans, const std::string& second_garments) {
    return [=](rosbag::Bag& bag) {
      write_scan(bag, 10, scan_at(10), "/left/scan/points");
      write_scan(bag, 11, scan_at(11), second_scans);
      bag.write("/left/garment", ros::Time(12), Garment());
      bag.write(second_garments, ros::Time(13), Garment());
    };
  };
  EXPECT_EQ(found_in(fill("left/scan/points", "left/garment")), Names{});  // the same topics
  EXPECT_EQ(found_in(fill("/right/scan/points", "/left/garment")), Names{"many_booths"});
  EXPECT_NE(check_.findings[0].what.find("left/scan/points, right/scan/points"), std::string::npos);
  EXPECT_EQ(found_in(fill("/left/scan/points", "/right/garment")), Names{"many_booths"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {  // one of each
              write_scan(bag, 10, scan_at(10), "/left/scan/points");
              bag.write("/right/garment", ros::Time(12), Garment());
            }),
            Names{"many_booths"});
}

TEST_F(CheckBagTest, AGoodBagIsDescribed) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              for (int second : {10, 11, 12, 13}) write_scan(bag, second, scan_at(second, 6000, 300));
            }),
            Names{});
  ASSERT_EQ(check_.topics.size(), 1u);
  EXPECT_EQ(check_.topics[0].messages, 4u);
  EXPECT_EQ(check_.topics[0].frames, "booth");
  EXPECT_EQ(check_.topics[0].largest_gap, 1);
  ASSERT_EQ(check_.scans.size(), 4u);
  EXPECT_EQ(check_.scans[0].points, 6000u);
  EXPECT_EQ(check_.scans[0].not_finite, 0.05);
}

TEST_F(CheckBagTest, FilesThatAreNoBags) {
  EXPECT_EQ(found(), Names{"no_file"});
  std::ofstream(path_) << "ply\n";
  EXPECT_EQ(found(), Names{"broken_bag"});
  std::ofstream(path_, std::ios::trunc) << "";
  EXPECT_EQ(found(), Names{"broken_bag"});
}

TEST_F(CheckBagTest, TruncatedWhereverItIsCut) {
  found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10)); });
  for (std::uintmax_t size = fs::file_size(path_) - 1; size > 10; size = size * 3 / 4) {
    fs::resize_file(path_, size);
    const Names names = found();
    ASSERT_EQ(names.size(), 1u) << size;
    EXPECT_TRUE(names[0] == "broken_bag" || names[0] == "unindexed_bag") << size << ": " << names[0];
  }
}

TEST_F(CheckBagTest, EmptyAndWithoutScans) {
  EXPECT_EQ(found_in([](rosbag::Bag&) {}), Names{"empty_bag"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { bag.write("/garment", ros::Time(1), Garment()); }),
            Names{"no_scan"});
}

TEST_F(CheckBagTest, WrongTopicsAndTypes) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10), "/camera/depth/points"); }),
            Names{"wrong_topic"});
  EXPECT_NE(check_.findings[0].advice.find("/camera/depth/points:=/scan/points"), std::string::npos);
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10), "/my_scan/points"); }),
            Names{"wrong_topic"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10), "/booth_2/scan/points"); }),
            Names{});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { bag.write("/scan/points", ros::Time(1), std_msgs::String()); }),
            (Names{"wrong_type", "no_scan"}));
}

TEST_F(CheckBagTest, SensorsOfABoothGoThroughTheAssembler) {
  const auto sensors = [](rosbag::Bag& bag) {
    for (const char* sensor : {"0", "1", "2"})
      write_scan(bag, 10, scan_at(10, 300), "/sensors/" + std::string(sensor) + "/points");
  };
  EXPECT_EQ(found_in(sensors), Names{"note sensors"});
  EXPECT_TRUE(check_.can_be_replayed());
  EXPECT_NE(check_.findings[0].advice.find("assemble:=true"), std::string::npos);
  EXPECT_EQ(check_.findings[0].advice.find(":=/scan/points"), std::string::npos)
      << "one of them is not the scan";
}

TEST_F(CheckBagTest, AnotherVersionOfAMessage) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              write_scan(bag, 10, scan_at(10));
              const auto old = boost::make_shared<ros::M_string>(
                  ros::M_string{{"topic", "/garment"},
                                {"type", "tensegric_fit/Garment"},
                                {"md5sum", "0123456789abcdef0123456789abcdef"},
                                {"message_definition", "string name\n"}});
              bag.write("/garment", ros::Time(11), Garment(), old);
            }),
            Names{"other_version"});
  EXPECT_NE(check_.findings[0].what.find("/garment"), std::string::npos);
}

TEST_F(CheckBagTest, StampsAndFrames) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              write_scan(bag, 10, scan_at(20));
              write_scan(bag, 11, scan_at(19.5));
            }),
            Names{"stamps_backwards"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              sensor_msgs::PointCloud2 scan = scan_at(10);
              write_scan(bag, 10, scan);
              scan = scan_at(11);
              scan.header.frame_id = "";
              write_scan(bag, 11, scan);
            }),
            (Names{"note no_frame", "note many_frames", "note no_tf", "note no_tf"}));
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(0)); }), Names{"note no_stamp"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              for (int second : {10, 11, 12, 40, 41}) write_scan(bag, second, scan_at(second));
            }),
            Names{"note gap"});
}

TEST_F(CheckBagTest, ScansThatNoBodyCanBeSeenIn) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10, 100)); }), Names{"bad_scan"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10, 6000, 6000)); }),
            Names{"bad_scan"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) { write_scan(bag, 10, scan_at(10, 12000, 6000)); }),
            Names{"note not_finite"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              sensor_msgs::PointCloud2 scan = scan_at(10);
              scan.data.resize(1000);
              write_scan(bag, 10, scan);
            }),
            Names{"bad_scan"});
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              sensor_msgs::PointCloud2 scan = scan_at(10);
              scan.fields[2].name = "depth";
              write_scan(bag, 10, scan);
            }),
            Names{"bad_scan"});
}

TEST_F(CheckBagTest, ACloudThatNoStageTakesHindersNothing) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              write_scan(bag, 10, scan_at(10));
              sensor_msgs::PointCloud2 odd = scan_at(11);
              bag.write("/lidar", ros::Time(11), odd);
              odd = scan_at(10.5);
              odd.fields[2].name = "depth";
              bag.write("/lidar", ros::Time(12), odd);
            }),
            (Names{"note stamps_backwards", "note bad_scan"}));
}

TEST_F(CheckBagTest, LatchedMessagesThatWentIntoAnotherPart) {
  EXPECT_EQ(found_in([](rosbag::Bag& bag) {
              write_scan(bag, 10, scan_at(10));
              DeformedMesh deformed;
              deformed.scan_id = "A";
              bag.write("/body/deformed", ros::Time(11), deformed);
              TriangleMesh body;
              body.scan_id = "B";
              bag.write("/body/mesh", ros::Time(12), body);
            }),
            (Names{"lost_latched", "note no_model"}));
}

TEST_F(CheckBagTest, ABodyOfABagFromBeforeTheBodyModel) {
  const auto with_model = [](const std::string& scan_id) {
    return [scan_id](rosbag::Bag& bag) {
      write_scan(bag, 10, scan_at(10));
      TriangleMesh body;
      body.scan_id = "A";
      bag.write("/body/mesh", ros::Time(12), body);
      BodyModel model;
      model.scan_id = scan_id;
      bag.write("/body/model", ros::Time(12), model);
    };
  };
  EXPECT_EQ(found_in(with_model("A")), Names{});
  EXPECT_EQ(found_in(with_model("B")), Names{"note no_model"});
}

}  // namespace
}  // namespace tensegric_fit::node
