/// What the correlation stage does with messages, without a master.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <optional>
#include <string>

#include "correlation/correlation_handler.hpp"
#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros_messages.hpp"
#include "xyz_cloud.hpp"

namespace tensegric_fit::node {
namespace {

/// Fits and worn scans of one body; measuring a worn scan is counted, and refused.
class CorrelationHandlerTest : public testing::Test {
 protected:
  using Input = CorrelationHandler::Input;

  void SetUp() override { add_body(handler_); }
  static void add_body(CorrelationHandler& handler, const ros::Time& stamp = some_tag().header.stamp) {
    const auto body = boost::make_shared<TriangleMesh>(to_message(some_tag(), tetrahedron(), {}));
    body->header.stamp = stamp;
    body->filled.push_back(0);  // one flag too many
    handler.add(TriangleMesh::ConstPtr(body));
    const auto landmarks = boost::make_shared<Landmarks>();
    landmarks->scan_id = body->scan_id;
    handler.add(Landmarks::ConstPtr(landmarks));
    handler.add(
        ControlMesh::ConstPtr(boost::make_shared<ControlMesh>(to_message(some_tag(), small_control_mesh()))));
  }
  /// Another garment.
  std::optional<Input> fit() { return fit(handler_); }
  static std::optional<Input> fit(CorrelationHandler& handler) {
    const auto deformed = boost::make_shared<DeformedMesh>();
    deformed->scan_id = some_tag().scan_id;
    return handler.add(DeformedMesh::ConstPtr(deformed));
  }
  /// Another number of points is another scan.
  std::optional<Input> worn(std::size_t points) {
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(xyz_cloud(points));
    return handler_.add(sensor_msgs::PointCloud2::ConstPtr(cloud), tag_of(*cloud));
  }
  std::string refusal(const std::optional<Input>& input) {
    return input ? code_of([&] { handler_.handle(*input); }) : "no input";
  }

  std::string refusal_ = "not_a_body";  ///< of each scan; empty: none
  int measured_ = 0;
  CorrelationHandler handler_{Parameters(YAML::Load("{}"), "correlation"),
                              [this](const geometry::PointCloud&) -> MeasuredScan {
                                ++measured_;
                                if (refusal_.empty()) return {};
                                throw geometry::Refusal(refusal_, "as the test has it");
                              }};
};

TEST_F(CorrelationHandlerTest, ARefusedScanIsNotMeasuredAgainForAnotherGarment) {
  EXPECT_FALSE(fit());  // no worn scan so far
  EXPECT_EQ(refusal(worn(1)), "not_a_body");
  EXPECT_EQ(refusal(fit()), "not_a_body");
  EXPECT_EQ(measured_, 1);
  EXPECT_EQ(refusal(worn(2)), "not_a_body");
  EXPECT_EQ(measured_, 2);
}

// It ran out of time or memory, which were the machine's.
TEST_F(CorrelationHandlerTest, ASurfaceThatFailedIsTriedAgain) {
  refusal_ = geometry::refusal::kSurfaceFailed;
  fit();
  EXPECT_EQ(refusal(worn(1)), "surface_failed");
  EXPECT_EQ(refusal(fit()), "surface_failed");
  EXPECT_EQ(measured_, 2);
}

// Where the node was started again, what is latched comes in any order. Only a body that was scanned before
// the worn scan is hers.
TEST_F(CorrelationHandlerTest, AWornScanThatCameFirstIsComparedWithABodyScannedBeforeIt) {
  const ros::Time bare(100);
  for (const ros::Time& worn : {ros::Time(0), ros::Time(99), ros::Time(101)}) {
    CorrelationHandler started{Parameters(YAML::Load("{}"), "correlation"),
                               [](const geometry::PointCloud&) { return MeasuredScan{}; }};
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(xyz_cloud(1));
    cloud->header.stamp = worn;
    EXPECT_EQ(code_of([&] { started.add(sensor_msgs::PointCloud2::ConstPtr(cloud), tag_of(*cloud)); }),
              "nothing_yet");
    EXPECT_EQ(started.waits(tag_of(*cloud).scan_id), !worn.isZero());
    add_body(started, bare);
    EXPECT_EQ(fit(started).has_value(), worn > bare);
  }
}

// She put the garment on while the scan without it was being reconstructed.
TEST_F(CorrelationHandlerTest, AWornScanThatCameBeforeItsBodyIsKeptForIt) {
  for (const int stamp : {0, 99, 101}) {
    const auto cloud = boost::make_shared<sensor_msgs::PointCloud2>(xyz_cloud(1));
    cloud->header.stamp = ros::Time(stamp);
    CorrelationHandler handler{Parameters(YAML::Load("{}"), "correlation"),
                               [](const geometry::PointCloud&) { return MeasuredScan{}; }};
    const auto before = boost::make_shared<TriangleMesh>(to_message(some_tag(), tetrahedron(), {}));
    before->scan_id = "the customer before";
    before->header.stamp = ros::Time(50);
    handler.add(TriangleMesh::ConstPtr(before));
    handler.add(sensor_msgs::PointCloud2::ConstPtr(cloud), tag_of(*cloud));
    add_body(handler, ros::Time(100));
    const std::optional<Input> input = fit(handler);
    EXPECT_EQ(input.has_value(), stamp == 101) << stamp;
    if (input) {
      EXPECT_EQ(input->worn.tag.scan_id, tag_of(*cloud).scan_id);
    }
  }
}

TEST_F(CorrelationHandlerTest, ReadsWhatTheFirstScanDidNotSee) {
  refusal_.clear();
  fit();
  const std::optional<Input> input = worn(1);
  ASSERT_TRUE(input);
  try {
    handler_.handle(*input);
    ADD_FAILURE() << "not refused";
  } catch (const geometry::Refusal& refused) {
    EXPECT_NE(std::string(refused.what()).find("`filled`"), std::string::npos) << refused.what();
  }
}

}  // namespace
}  // namespace tensegric_fit::node
