/// The assembler as a booth's sensors meet it: clouds and tf in, scans out.
#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "chain_client.hpp"
#include "recorded_booth.hpp"

namespace tensegric_fit::tests {
namespace {

constexpr double kTimeout = 3;  // s, of the assemblers: assembler.test.in

Eigen::Isometry3d pose_of(const Recording& recording, int sensor) {
  const auto& transform = recording.poses.transforms[sensor].transform;
  return Eigen::Translation3d(transform.translation.x, transform.translation.y, transform.translation.z) *
         Eigen::Quaterniond(transform.rotation.w, transform.rotation.x, transform.rotation.y,
                            transform.rotation.z);
}

/// What a sensor saw of a body, in the booth's frame.
std::vector<Eigen::Vector3d> seen_by(const std::string& body, int sensor) {
  const Recording& recording = recorded(body);
  const Eigen::Isometry3d pose = pose_of(recording, sensor);
  std::vector<Eigen::Vector3d> points;
  for (sensor_msgs::PointCloud2ConstIterator<float> at(recording.clouds[sensor], "x"); at != at.end(); ++at)
    points.push_back(pose * Eigen::Vector3d(at[0], at[1], at[2]));
  return points;
}

/// A booth in a namespace, with an assembler.
class Booth {
 public:
  explicit Booth(const std::string& name)
      : node_(name), stage_(name + "/assembler: assembler"), sensors_(name) {
    scan_ = node_.subscribe<sensor_msgs::PointCloud2>("scan/points", 8,
                                                      [this](const sensor_msgs::PointCloud2::ConstPtr& scan) {
                                                        if (scan->header.stamp >= since_)
                                                          scans.push_back(scan);
                                                      });
    said_ = node_.subscribe("/diagnostics", 1000, &Booth::on_diagnostics, this);
  }

  bool ready() {
    return wait_for([this] { return scan_.getNumPublishers() == 1 && !facts.empty() && sensors_.heard(); });
  }

  void send(const std::string& body, int sensor, double stamp) {
    since_ = std::min(since_, ros::Time(stamp));
    sensors_.send(body, sensor, stamp);
  }
  void send(const sensor_msgs::PointCloud2& cloud, int sensor) {
    since_ = std::min(since_, cloud.header.stamp);
    sensors_.send(cloud, sensor);
  }

  void send_all(const std::string& body, double stamp, int but = -1) {
    since_ = std::min(since_, ros::Time(stamp));
    sensors_.send_all(body, stamp, but);
  }

  bool scanned(std::size_t count) {
    return wait_for([&] { return scans.size() == count; });
  }

  /// Waits until that was the last thing that went wrong.
  bool says(const std::string& code, const std::string& words) {
    return wait_for([&] {
      return facts["last_error"] == code && facts["last_error_message"].find(words) != std::string::npos;
    });
  }

  std::vector<sensor_msgs::PointCloud2::ConstPtr> scans;
  std::map<std::string, std::string> facts;  ///< newest, with level and message

 private:
  void on_diagnostics(const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
    for (const diagnostic_msgs::DiagnosticStatus& status : message->status) {
      if (status.name != stage_) continue;
      facts["level"] = std::to_string(status.level);
      facts["message"] = status.message;
      for (const diagnostic_msgs::KeyValue& fact : status.values) facts[fact.key] = fact.value;
    }
  }

  ros::NodeHandle node_;
  std::string stage_;
  ros::Time since_ = ros::TIME_MAX;  // of the first cloud sent: latched scans of earlier ones do not count
  RecordedBooth sensors_;
  ros::Subscriber scan_, said_;
};

/// All points of the body's sensors but one, each where its sensor saw it, with a normal that looks back.
void expect_scan(const sensor_msgs::PointCloud2& scan, const std::string& body, int but = -1) {
  sensor_msgs::PointCloud2ConstIterator<float> at(scan, "x"), normal(scan, "normal_x");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> sensor_at(scan, "sensor");
  std::size_t count = 0;
  for (int sensor = 0; sensor < kSensors; ++sensor) {
    if (sensor == but) continue;
    const Eigen::Vector3d viewpoint = pose_of(recorded(body), sensor).translation();
    for (const Eigen::Vector3d& seen : seen_by(body, sensor)) {
      ASSERT_LT(count++, scan.width);
      ASSERT_EQ(*sensor_at, sensor);
      const Eigen::Vector3d p(at[0], at[1], at[2]), n(normal[0], normal[1], normal[2]);
      ASSERT_LT((p - seen).norm(), 0.005);  // columns are 0.5 mm off (deviation), and moved to fit
      ASSERT_NEAR(n.norm(), 1, 1e-5);
      ASSERT_GT(n.dot(viewpoint - p), -0.02);  // the correction turns it by a few milliradians
      ++at, ++normal, ++sensor_at;
    }
  }
  EXPECT_EQ(count, scan.width * scan.height);
}

class AssemblerTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(booth_.ready()) << "the assembler did not come up"; }
  Booth booth_{"strict"};
};

TEST_F(AssemblerTest, TwoCapturesInARow) {
  booth_.send_all("a", 100);
  ASSERT_TRUE(booth_.scanned(1));
  booth_.send_all("b", 103);
  ASSERT_TRUE(booth_.scanned(2));
  expect_scan(*booth_.scans[0], "a");
  expect_scan(*booth_.scans[1], "b");
  EXPECT_EQ(booth_.scans[0]->header.frame_id, "strict/booth");
  EXPECT_EQ(booth_.scans[0]->header.stamp, ros::Time(100));
  EXPECT_EQ(booth_.scans[1]->header.stamp, ros::Time(103));
  EXPECT_TRUE(wait_for([&] { return booth_.facts["state"] == "done"; }));
  EXPECT_EQ(booth_.facts["registration"], "refined");
  EXPECT_LT(std::stod(booth_.facts["overlap_mm_after"]), std::stod(booth_.facts["overlap_mm_before"]));
}

TEST_F(AssemblerTest, CapturesThatCrossEachOtherAreNotMixed) {
  booth_.send_all("a", 200, 11);
  booth_.send_all("b", 201);
  ASSERT_TRUE(booth_.scanned(1));
  booth_.send("a", 11, 200.055);
  EXPECT_TRUE(booth_.says("late_cloud", "sensors/11/points"));
  listen(kTimeout + 0.5);  // for what should not come
  ASSERT_EQ(booth_.scans.size(), 1u);
  expect_scan(*booth_.scans[0], "b");
  EXPECT_EQ(booth_.facts["state"], "done");  // as before the late cloud
}

TEST_F(AssemblerTest, ARecordingPlayedAgainIsNamed) {
  booth_.send_all("a", 250);
  ASSERT_TRUE(booth_.scanned(1));
  booth_.send_all("a", 250);
  EXPECT_TRUE(booth_.says("late_cloud", "to play a recording again"));
  EXPECT_EQ(booth_.scans.size(), 1u);
}

// When it is named: assembler_capture_join_test.cpp.
TEST_F(AssemblerTest, AMissingSensorIsNamedAndTheNextCaptureWorks) {
  booth_.send_all("a", 300, 4);
  EXPECT_TRUE(booth_.says("missing_sensor", "missing: sensors/4/points"));
  booth_.send("a", 4, 300.02);
  EXPECT_TRUE(booth_.says("late_cloud", "sensors/4/points"));
  EXPECT_TRUE(booth_.scans.empty());
  booth_.send_all("b", 303);
  ASSERT_TRUE(booth_.scanned(1));
  expect_scan(*booth_.scans[0], "b");
}

TEST_F(AssemblerTest, CloudsThatCannotBeUsedAreNamedWithTheirSensor) {
  sensor_msgs::PointCloud2 cloud = recorded("a").clouds[2];
  cloud.header.stamp = ros::Time(400);
  cloud.data.resize(100);
  booth_.send(cloud, 2);
  EXPECT_TRUE(booth_.says("broken_file", "sensors/2/points"));
  cloud = recorded("a").clouds[3];
  cloud.header.stamp = ros::Time();
  booth_.send(cloud, 3);
  EXPECT_TRUE(booth_.says("no_stamp", "sensors/3/points"));
  cloud.header.stamp = ros::Time(401);
  cloud.header.frame_id = "nowhere";
  booth_.send_all("a", 401, 3);
  booth_.send(cloud, 3);
  EXPECT_TRUE(booth_.says("no_transform", "sensors/3/points"));
  EXPECT_TRUE(booth_.scans.empty());
}

TEST_F(AssemblerTest, SensorsThatSendFasterThanAScanIsAssembledGetScansAllTheSame) {
  booth_.send_all("a", 600);
  // Work on it has begun, or is done: of 36 clouds at once a busy machine takes longer than kTimeout.
  ASSERT_TRUE(wait_for([this] { return booth_.facts["scan_id"].rfind("600.", 0) == 0; }));
  for (const double stamp : {601, 602}) booth_.send_all("a", stamp);
  ASSERT_TRUE(wait_for(
      [this] { return !booth_.scans.empty() && booth_.scans.back()->header.stamp == ros::Time(602); }));
  EXPECT_EQ(booth_.scans.front()->header.stamp, ros::Time(600)) << "newer captures took its place";
}

TEST_F(AssemblerTest, CloudsInOneFrameComeWithoutNormalsAndWithAWarning) {
  booth_.send_all("a", 700, 1);
  sensor_msgs::PointCloud2 cloud = recorded("a").clouds[1];
  cloud.header.stamp = ros::Time(700.005);
  cloud.header.frame_id = "strict/" + recorded("a").clouds[0].header.frame_id;
  booth_.send(cloud, 1);
  ASSERT_TRUE(booth_.scanned(1));
  const sensor_msgs::PointCloud2& scan = *booth_.scans[0];
  sensor_msgs::PointCloud2ConstIterator<float> normal(scan, "normal_x");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> sensor(scan, "sensor");
  for (; sensor != sensor.end(); ++sensor, ++normal)
    ASSERT_NEAR(Eigen::Vector3d(normal[0], normal[1], normal[2]).norm(), *sensor < 2 ? 0 : 1, 1e-5);
  EXPECT_TRUE(wait_for([this] {
    return booth_.facts["level"] == std::to_string(diagnostic_msgs::DiagnosticStatus::WARN) &&
           booth_.facts["message"].find("sensors/0/points and sensors/1/points are in one frame") !=
               std::string::npos;
  }));
}

TEST(LenientAssemblerTest, WithEnoughSensorsWhatIsThereComesWithAWarning) {
  Booth booth("lenient");
  ASSERT_TRUE(booth.ready());
  booth.send_all("a", 500, 7);
  ASSERT_TRUE(booth.scanned(1));
  expect_scan(*booth.scans[0], "a", 7);
  EXPECT_TRUE(wait_for([&] {
    return booth.facts["level"] == std::to_string(diagnostic_msgs::DiagnosticStatus::WARN) &&
           booth.facts["message"].find("missing: sensors/7/points") != std::string::npos;
  }));
}

TEST(PlayedBagTest, ABagOfAllSensorsBecomesOneScan) {
  sensor_msgs::PointCloud2::ConstPtr scan;
  const boost::function<void(const sensor_msgs::PointCloud2::ConstPtr&)> take =
      [&scan](const sensor_msgs::PointCloud2::ConstPtr& message) { scan = message; };
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::PointCloud2>("scan/points", 1, take);
  ASSERT_TRUE(wait_for([&] { return scan != nullptr; }));
  EXPECT_EQ(scan->header.frame_id, "booth");
  EXPECT_EQ(scan->header.stamp, recorded("a").clouds[0].header.stamp);
  expect_scan(*scan, "a");
}

}  // namespace
}  // namespace tensegric_fit::tests
