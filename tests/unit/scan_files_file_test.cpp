#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
#include <pcl_conversions/pcl_conversions.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "geometry/ply.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"
#include "scan_files/cloud_message.hpp"
#include "scan_files/scan_bag.hpp"
#include "scan_files/scan_file.hpp"
#include "virtual_booth/sensor_bag.hpp"

namespace tensegric_fit {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class ScanFileTest : public testing::Test {
 protected:
  ScanFileTest() { fs::create_directories(folder_); }
  ~ScanFileTest() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  std::string text_file(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  // The first `share` of a file's bytes, under another name with the same ending.
  std::string cut(const std::string& path, double share) const {
    const std::string copy = file("cut_" + fs::path(path).filename().string());
    fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    fs::resize_file(copy, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(path))));
    return copy;
  }

  static geometry::PointCloud cloud() {
    geometry::PointCloud result;
    for (int i = 0; i < 500; ++i)
      result.points.emplace_back(0.25 * i, 0.5 - i, 0.125 * i * i);  // exact as float32
    return result;
  }

  static pcl::PointCloud<pcl::PointXYZ> pcl_cloud() {
    pcl::PointCloud<pcl::PointXYZ> result;
    for (const Vector3d& p : cloud().points) result.emplace_back(p.x(), p.y(), p.z());
    return result;
  }

  static void expect_cloud(const std::string& path) {
    EXPECT_EQ(geometry::points_of(scan_files::read_scan_file(path).cloud).points, cloud().points) << path;
  }

  static std::string refusal_of(const std::string& path) {
    try {
      scan_files::read_scan_file(path);
    } catch (const geometry::Refusal& refusal) {
      EXPECT_NE(std::string(refusal.what()).find(fs::path(path).filename().string()), std::string::npos);
      return refusal.code();
    }
    return "accepted";
  }

 private:
  const fs::path folder_ =
      fs::temp_directory_path() / ("tensegric_fit_scan_file_" + std::to_string(getpid()));
};

TEST_F(ScanFileTest, EveryKindIsReadAsItWasWritten) {
  geometry::write_ply_mesh(file("a.ply"), {cloud().points, {}});
  expect_cloud(file("a.ply"));
  pcl::io::savePCDFileASCII(file("ascii.pcd"), pcl_cloud());
  pcl::io::savePCDFileBinary(file("binary.pcd"), pcl_cloud());
  pcl::io::savePCDFileBinaryCompressed(file("compressed.PCD"), pcl_cloud());
  for (const char* name : {"ascii.pcd", "binary.pcd", "compressed.PCD"}) expect_cloud(file(name));
  scan_files::write_bag_scan(file("a.bag"), cloud(), "booth", std::chrono::seconds(5));
  expect_cloud(file("a.bag"));
}

TEST_F(ScanFileTest, AMeshThatIsInsideOutIsTurned) {
  geometry::TriangleMesh box{{{0, 0, 0}, {0.4, 0, 0}, {0, 0.3, 0}, {0, 0, 1.7}},
                             {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const auto triangles = box.triangles;
  for (const bool turned : {false, true}) {
    if (turned)
      for (Eigen::Vector3i& t : box.triangles) std::swap(t[1], t[2]);
    geometry::write_ply_mesh(file("body.ply"), box);
    mesh_files::Reading reading;
    EXPECT_EQ(scan_files::read_body_mesh(file("body.ply"), {"m", "z"}, false, reading).triangles, triangles);
  }
}

TEST_F(ScanFileTest, BagsOfOneCloudAreTheSameBytes) {
  const auto bytes = [](const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  scan_files::write_bag_scan(file("a.bag"), cloud(), "booth", std::chrono::seconds(5));
  scan_files::write_bag_scan(file("b.bag"), cloud(), "booth", std::chrono::seconds(5));
  EXPECT_EQ(bytes(file("a.bag")), bytes(file("b.bag")));
}

TEST_F(ScanFileTest, ABagsScanTopicComesBeforeOtherClouds) {
  scan_files::write_bag_scan(file("a.bag"), cloud(), "booth", std::chrono::seconds(5));
  {
    rosbag::Bag bag(file("a.bag"), rosbag::bagmode::Append);
    bag.write("/another/points", ros::Time(1), sensor_msgs::PointCloud2());  // earlier, and empty
  }
  expect_cloud(file("a.bag"));
  {
    rosbag::Bag bag(file("a.bag"), rosbag::bagmode::Append);
    bag.write("/booth_2/scan/points", ros::Time(7), sensor_msgs::PointCloud2());
  }
  EXPECT_EQ(refusal_of(file("a.bag")), geometry::refusal::kBadOption) << "of which booth?";
}

TEST_F(ScanFileTest, ABagOfAllSensorsHasTheirClouds) {
  std::vector<virtual_booth::SensorScan> scans(2);
  for (std::size_t sensor = 0; sensor < scans.size(); ++sensor) {
    virtual_booth::SensorPose& pose = scans[sensor].pose;
    pose.booth_from_sensor = Eigen::Translation3d(1.0 + sensor, 0, 2) *
                             Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());  // x is the booth's y
    scans[sensor].cloud.points = {pose.booth_from_sensor * Vector3d(1, 2, 3)};
  }
  virtual_booth::write_sensor_bag(file("sensors.bag"), scans, "booth", std::chrono::seconds(5));
  int clouds = 0, poses = 0;
  const rosbag::Bag bag(file("sensors.bag"));
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>()) {
      const std::string sensor = std::to_string(clouds);
      EXPECT_EQ(message.getTopic(), "/sensors/" + sensor + "/points");
      EXPECT_EQ(cloud->header.frame_id, "sensor_" + sensor);
      EXPECT_EQ(cloud->header.stamp, ros::Time(5, 1000000 * clouds++));
      pcl::PCLPointCloud2 points;
      pcl_conversions::toPCL(*cloud, points);
      const geometry::PointCloud seen = geometry::points_of(points);
      ASSERT_EQ(seen.points.size(), 1u);
      EXPECT_LT((seen.points[0] - Vector3d(1, 2, 3)).norm(), 1e-6);  // float32
    }
    if (const auto tf = message.instantiate<tf2_msgs::TFMessage>()) {
      poses = static_cast<int>(tf->transforms.size());
      EXPECT_EQ(tf->transforms.at(1).child_frame_id, "sensor_1");
      EXPECT_EQ(tf->transforms.at(1).transform.translation.x, 2);
      EXPECT_NEAR(tf->transforms.at(1).transform.rotation.z, std::sqrt(0.5), 1e-12);
    }
  }
  EXPECT_EQ(clouds, 2);
  EXPECT_EQ(poses, 2);
  rosbag::View all(bag);
  EXPECT_EQ(all.getEndTime(), ros::Time(7)) << "rosbag play loses what is last: no cloud is";
  // None of them is the scan.
  EXPECT_EQ(refusal_of(file("sensors.bag")), geometry::refusal::kBadOption);
}

TEST_F(ScanFileTest, ABagWithoutACloudIsRefused) {
  {
    rosbag::Bag bag(file("text.bag"), rosbag::bagmode::Write);
    bag.write("/scan/points", ros::Time(1), std_msgs::String());
  }
  EXPECT_EQ(refusal_of(file("text.bag")), geometry::refusal::kBrokenFile);
}

TEST_F(ScanFileTest, TruncatedFilesAreRefused) {
  geometry::write_ply_mesh(file("a.ply"), {cloud().points, {}});
  pcl::io::savePCDFileASCII(file("ascii.pcd"), pcl_cloud());
  pcl::io::savePCDFileBinary(file("binary.pcd"), pcl_cloud());
  pcl::io::savePCDFileBinaryCompressed(file("compressed.pcd"), pcl_cloud());
  scan_files::write_bag_scan(file("a.bag"), cloud(), "booth", std::chrono::seconds(5));
  for (const char* name : {"a.ply", "ascii.pcd", "binary.pcd", "compressed.pcd", "a.bag"})
    for (const double share : {0.0, 0.01, 0.2, 0.5, 0.9})
      EXPECT_EQ(refusal_of(cut(file(name), share)), geometry::refusal::kBrokenFile)
          << name << " cut to " << share;
}

TEST_F(ScanFileTest, HeadersThatPromiseTooMuchAreRefusedBeforeMemoryIsTaken) {
  const std::string fields = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  const std::string many = "WIDTH 4000000000\nHEIGHT 1000000\nVIEWPOINT 0 0 0 1 0 0 0\n";
  const std::string some = "WIDTH 1000000000\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1000000000\n";
  for (const std::string& size : {many, some})
    for (const char* data : {"ascii", "binary", "binary_compressed"})
      EXPECT_EQ(refusal_of(text_file("huge.pcd", fields + size + "DATA " + data + "\n0 0 0\n1 1 1\n")),
                geometry::refusal::kBrokenFile)
          << size << data;
  EXPECT_EQ(refusal_of(text_file("huge.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                                 "property float y\nproperty float z\nend_header\n0 0 0\n")),
            geometry::refusal::kBrokenFile);
}

// Found by fuzzing: PCL's reader crashed.
TEST_F(ScanFileTest, APcdHeaderOutOfOrderOrWithoutFieldsIsRefused) {
  const std::string fields = "FIELDS x y z\n", rest = "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  const std::string end = "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n0 0 0\n1 1 1\n";
  for (const std::string& header :
       {"FI\n\n\nELDS x y z\n" + rest, rest, rest + fields, fields + fields + rest, fields + rest + fields,
        "FIELDS x y\n" + rest, fields + "SIZE 4 4 4\nTYPE F F\nCOUNT 1 1 1\n"})
    EXPECT_EQ(refusal_of(text_file("a.pcd", header + end)), geometry::refusal::kBrokenFile) << header;
  EXPECT_EQ(refusal_of(text_file("a.pcd", fields + rest + end)), "accepted") << "as it should be";
}

// Found by fuzzing: PCL took words for the number 0, and read beyond its fields.
TEST_F(ScanFileTest, APcdHeaderWithWordsForNumbersOrUnknownTypesIsRefused) {
  const std::string fields = "FIELDS x y z\n", size = "SIZE 4 4 4\n", type = "TYPE F F F\n",
                    end = "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0 0 0\n1 1 1\n";
  for (const std::string& header :
       {size + type + "COUNT null 1 1\n", size + type + "COUNT 0 0 0\n", size + type + "COUNT 1 1 1 null\n",
        size + type + "COUNT\n", "SIZE 4 4 4x\n" + type, "SIZE 4 4 3\n" + type, "SIZE 4 4 2\n" + type,
        size + "TYPE F null 0\n"})
    EXPECT_EQ(refusal_of(text_file("a.pcd", fields + header + end)), geometry::refusal::kBrokenFile)
        << header;
  EXPECT_EQ(refusal_of(text_file("a.pcd", fields + size + type + end)), "accepted") << "as it should be";
}

// PCL parts words at other characters, and ends a header at a line of blanks: it then wrote beyond its
// points.
TEST_F(ScanFileTest, APcdHeaderThatPclPartsInAnotherWayIsRefused) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n";
  for (const std::string& text :
       {head + "DATA\fascii binary_compressed\n0 0 0\n1 1 1\n", head + "\r\nDATA ascii\n0 0 0\n1 1 1\n",
        head + " \nDATA ascii\n0 0 0\n1 1 1\n", head + "DATA binary_compressed\n" + std::string(8, '\0')})
    EXPECT_EQ(refusal_of(text_file("a.pcd", text)), geometry::refusal::kBrokenFile) << text;
  std::string huge = "FIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT";
  for (int i = 0; i < 20; ++i)
    huge += " f" + std::to_string(i), sizes += " 8", types += " F", counts += " 1048576";
  EXPECT_EQ(refusal_of(text_file("a.pcd",
                                 huge + sizes + types + counts + "\nWIDTH 100\nHEIGHT 1\nDATA binary\nxxxx")),
            geometry::refusal::kBrokenFile);
}

// Found by fuzzing: PCL's reader read beyond the file.
TEST_F(ScanFileTest, APcdWhoseDataBeginAsALineOfItsHeaderIsRefused) {
  const std::string header =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
      "binary\n";
  for (const char* data :
       {"COUNT 900000000 1 1\n", "\n# \n  COUNT 900000000 1 1\n", "COLUMNS x\n", "DATA ascii\n"})
    EXPECT_EQ(refusal_of(text_file("a.pcd", header + data + std::string(24, 'x'))),
              geometry::refusal::kBrokenFile)
        << data;
  EXPECT_EQ(refusal_of(text_file("a.pcd", header + "# COUN\n" + std::string(17, 'x'))), "accepted")
      << "bytes of points";
}

// Found by fuzzing: PCL ended the process.
TEST_F(ScanFileTest, APlyWhoseVerticesHaveAListIsRefused) {
  for (const char* count : {"uchar", "int"})
    EXPECT_EQ(refusal_of(text_file(
                  "list.ply", std::string("ply\nformat ascii 1.0\nelement vertex 1\nproperty list ") + count +
                                  " int x\nend_header\n1 7\n")),
              geometry::refusal::kBrokenFile);
}

// Found by fuzzing: rosbag reads beyond its buffers where a length, an offset or a count lies.
TEST_F(ScanFileTest, ABagWithAByteThatLiesIsReadOrRefused) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string path = file("packed.bag"), changed = file("changed.bag");
    {
      rosbag::Bag bag(path, rosbag::bagmode::Write);
      bag.setCompression(compression);
      bag.write("/scan/points", ros::Time(1), scan_files::cloud_message(cloud(), "booth", ros::Time(1)));
      bag.write("/words", ros::Time(2), std_msgs::String());
    }
    expect_cloud(path);
    std::ifstream stream(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    int refused = 0;
    for (std::size_t at = 0; at < bytes.size(); at += 23) {  // all of them take a minute
      if (bytes[at] == ' ') continue;                        // what fills the bag's header
      std::string other = bytes;
      other[at] = static_cast<char>(~other[at]);
      std::ofstream(changed, std::ios::binary) << other;
      refused += refusal_of(changed) != "accepted";
    }
    EXPECT_GT(refused, 10);
  }
}

TEST_F(ScanFileTest, OtherFilesAreRefusedByName) {
  EXPECT_EQ(refusal_of(text_file("scan.txt", "0 0 0\n")), geometry::refusal::kBadOption);
  EXPECT_EQ(refusal_of(text_file("scan", "0 0 0\n")), geometry::refusal::kBadOption);
  for (const char* name : {"text.ply", "text.pcd", "text.bag"})
    EXPECT_EQ(refusal_of(text_file(name, "this is no scan\n")), geometry::refusal::kBrokenFile) << name;
  for (const char* name : {"absent.ply", "absent.pcd", "absent.bag", "absent.xyz", "absent.obj"})
    EXPECT_EQ(refusal_of(file(name)), geometry::refusal::kBrokenFile) << name;
}

/// A second field of that name is not read, nor is it written to: it may lie across others, or end beyond the
/// points.
TEST(ScanFileUnit, ChangesTheFieldsThatAreReadAndNoOther) {
  pcl::PCLPointCloud2 cloud;
  const auto add = [&cloud](const char* name, std::uint32_t offset, std::uint8_t type) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = type;
    field.count = 1;
    cloud.fields.push_back(field);
  };
  add("x", 0, pcl::PCLPointField::FLOAT32);
  add("y", 4, pcl::PCLPointField::FLOAT32);
  add("z", 8, pcl::PCLPointField::FLOAT32);
  add("x", 12, pcl::PCLPointField::UINT8);
  cloud.width = cloud.height = 1;
  cloud.point_step = cloud.row_step = 16;
  cloud.data.assign(16, 7);
  const float x = 1500;
  std::memcpy(cloud.data.data(), &x, sizeof x);
  scan_files::apply({"mm", "z"}, cloud);
  EXPECT_NEAR(geometry::points_of(cloud).points[0].x(), 1.5, 1e-6);
  for (std::size_t i = 12; i < 16; ++i) EXPECT_EQ(cloud.data[i], 7) << i;

  cloud.is_bigendian = cloud.is_bigendian == 0 ? 1 : 0;  // the same of a cloud in the other order of bytes
  std::memcpy(cloud.data.data(), &x, sizeof x);
  std::reverse(cloud.data.begin(), cloud.data.begin() + 4);
  scan_files::apply({"mm", "z"}, cloud);
  EXPECT_NEAR(geometry::points_of(cloud).points[0].x(), 1.5, 1e-6);
  for (std::size_t i = 12; i < 16; ++i) EXPECT_EQ(cloud.data[i], 7) << i;
}

TEST_F(ScanFileTest, FacesOfAPlyThatShareNoCornersAreJoinedAndCornersOfNoFaceLeftOut) {
  const std::array<Vector3d, 4> corners{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0),
                                        Vector3d(0, 0, 1)};
  geometry::TriangleMesh loose{{Vector3d(0, 0, -5)}, {}};
  for (const std::array<int, 3>& face : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int corner : face) loose.vertices.push_back(corners[corner]);
    loose.triangles.emplace_back(first, first + 1, first + 2);
  }
  geometry::write_ply_mesh(file("loose.ply"), loose);
  mesh_files::Reading reading;
  const geometry::TriangleMesh mesh =
      scan_files::read_body_mesh(file("loose.ply"), {"m", "z"}, false, reading);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(geometry::bounding_box(mesh.vertices)[0].z(), 0);
}

TEST_F(ScanFileTest, FacesOfAPlyWithoutThreeCornersAreLeftOutOfABodyAlone) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 5\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  mesh_files::Reading reading;
  const auto read = [&](const std::string& last_face, bool any_shape) {
    return scan_files::read_body_mesh(text_file("flat.ply", text + last_face), {"m", "z"}, any_shape,
                                      reading);
  };
  EXPECT_EQ(read("3 1 1 3\n", false).triangles.size(), 4u);
  EXPECT_THROW(read("3 1 1 3\n", true), geometry::Refusal) << "other shapes stay as they are";
  EXPECT_THROW(geometry::read_ply_mesh(file("flat.ply")), geometry::Refusal) << "control meshes, too";
  EXPECT_THROW(read("3 9 9 3\n", false), geometry::Refusal) << "a vertex that is not there";
}

}  // namespace
}  // namespace tensegric_fit
