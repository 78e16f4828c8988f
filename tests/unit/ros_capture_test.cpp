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

TEST_F(CaptureHandlerTest, ForgettingEndsTheGoalOfThatScanAlone) {
  EXPECT_FALSE(handler_.forget("another"));
  EXPECT_TRUE(handler_.forget(handler_.scan_id()));
  handler_.stop();
  EXPECT_FALSE(handler_.forget("another"));
}

TEST_F(CaptureHandlerTest, NoLandmarksOfAnotherAreKept) {
  const auto of = [](const std::string& scan_id) {
    const auto landmarks = boost::make_shared<Landmarks>();
    landmarks->scan_id = scan_id;
    return landmarks;
  };
  boost::weak_ptr<const Landmarks> before, late, earlier;
  handler_.begin({}, 0);
  before = [&] {
    auto it = of("before");
    handler_.add(Landmarks::ConstPtr(it));
    return it;
  }();
  EXPECT_FALSE(before.expired());  // may be of the scan that is to come
  sensor_msgs::PointCloud2 next = scan();
  next.header.stamp = ros::Time(101, 0);
  handler_.add(next);
  EXPECT_TRUE(before.expired());
  late = [&] {
    auto it = of("late");
    handler_.add(Landmarks::ConstPtr(it));
    return it;
  }();
  EXPECT_TRUE(late.expired());
  earlier = [&] {
    auto it = of(tag_of(next).scan_id);
    handler_.add(Landmarks::ConstPtr(it));
    return it;
  }();
  EXPECT_FALSE(earlier.expired());
  CaptureGoal refused;
  refused.timeout = -1;
  EXPECT_THROW(handler_.begin(refused, 0), geometry::Refusal);
  EXPECT_TRUE(earlier.expired());
}

TEST(CaptureTrigger, OneThatDoesNotAnswerIsNamed) {
  for (const std::vector<std::string>& sensors : {std::vector<std::string>{}, {"left"}})
    for (const bool pulled :
         {false, true}) {  // false: an earlier customer's call is still without its answer
      CaptureHandler handler(Parameters(YAML::Load("{timeout: 5, trigger: scanner/scan}"), "capture"), "/");
      CaptureGoal goal;
      goal.sensors = sensors;
      handler.begin(goal, 0);
      if (pulled) handler.pulled(100);
      handler.set_unanswered(true);
      EXPECT_FALSE(handler.result(4.9));
      const auto result = handler.result(5.1);
      ASSERT_TRUE(result);
      EXPECT_EQ(result->code, "trigger_failed");
      EXPECT_EQ(result->message.rfind("scanner/scan has not answered", 0), 0u) << result->message;
    }
}

TEST(CaptureTrigger, OneThatHasAnsweredIsNotBlamed) {
  CaptureHandler handler(Parameters(YAML::Load("{timeout: 5, trigger: scanner/scan}"), "capture"), "/");
  CaptureGoal goal;
  goal.sensors = {"left"};
  handler.begin(goal, 0);
  handler.pulled(100);
  handler.set_unanswered(false);
  const auto result = handler.result(5.1);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->code, "missing_sensor");
}

TEST(CaptureTrigger, ANameThatNoServiceCanHaveIsRefused) {
  for (const char* name : {"my-scanner/scan", "a b", "1st", "~scan", "/"})
    EXPECT_THROW(
        CaptureHandler(Parameters(YAML::Load(std::string("{trigger: ") + name + "}"), "capture"), "/"),
        geometry::Refusal)
        << name;
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
