/// The action `capture` from messages to its result. The clock is the test's own.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <limits>

#include "capture/capture_handler.hpp"
#include "geometry/status.hpp"
#include "ros/scan_tag.hpp"

namespace tensegric_fit::node {
namespace {

sensor_msgs::PointCloud2 scan() {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = ros::Time(100, 0);
  return cloud;
}

diagnostic_msgs::DiagnosticArray report(const std::vector<std::pair<std::string, std::string>>& facts) {
  diagnostic_msgs::DiagnosticArray array;
  array.status.resize(1);
  array.status[0].name = "reconstruction: reconstruction";
  for (const auto& [key, value] : facts) {
    array.status[0].values.emplace_back();
    array.status[0].values.back().key = key;
    array.status[0].values.back().value = value;
  }
  return array;
}

class CaptureHandlerTest : public testing::Test {
 protected:
  CaptureHandlerTest() : handler_(Parameters(YAML::Load("{timeout: 5}"), "capture"), "/") {
    handler_.begin({}, 0);
    handler_.add(scan());
  }

  CaptureHandler handler_;
  const std::string scan_id_ = tag_of(scan()).scan_id;
};

TEST_F(CaptureHandlerTest, AMeasuredScanIsTheResult) {
  EXPECT_FALSE(handler_.result(1));
  const auto landmarks = boost::make_shared<Landmarks>();
  landmarks->scan_id = scan_id_;
  handler_.add(Landmarks::ConstPtr(landmarks));
  const auto result = handler_.result(1);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->measured);
  EXPECT_EQ(result->landmarks.scan_id, scan_id_);
  EXPECT_FALSE(handler_.is_busy());
}

/// Once taken for a capture that had ended well, whose landmarks were then looked for in vain.
TEST_F(CaptureHandlerTest, ARefusalWithoutACodeIsARefusal) {
  handler_.add(report({{"state", "refused"}, {"scan_id", scan_id_}}), 1);
  const auto result = handler_.result(1);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->measured);
  EXPECT_EQ(result->code, "internal_error");
}

TEST_F(CaptureHandlerTest, SecondsThatAreNoNumberDoNotMakeProgress) {
  const float before = static_cast<float>(handler_.feedback(1).progress);
  for (const char* seconds : {"nan", "-inf", "inf", "-1e300", "soon"}) {
    handler_.add(report({{"state", "working"}, {"scan_id", scan_id_}, {"working_seconds", seconds}}), 1);
    EXPECT_FLOAT_EQ(static_cast<float>(handler_.feedback(1).progress), before) << seconds;
  }
}

TEST_F(CaptureHandlerTest, ATimeoutOutOfRangeIsRefusedAndZeroIsTheNodesOwn) {
  for (const double timeout : {-1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    CaptureGoal goal;
    goal.timeout = timeout;
    EXPECT_THROW(handler_.begin(goal, 0), geometry::Refusal) << timeout;
  }
  handler_.begin({}, 0);
  const auto dead = [&](double now) {
    handler_.add(report({{"state", "waiting"}}), now);
    return handler_.result(now);
  };
  EXPECT_FALSE(dead(4.9));
  ASSERT_TRUE(dead(5.1));
}

}  // namespace
}  // namespace tensegric_fit::node
