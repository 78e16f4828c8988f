/// A capture followed from its sensors to its measurements. The clock is the test's own.
#include <gtest/gtest.h>

#include "capture/capture_watch.hpp"
#include "capture/heard_sensors.hpp"

namespace tensegric_fit::capture {
namespace {

constexpr std::uint64_t kSecond = 1000000000;
constexpr double kSlop = 0.2;

class CaptureWatchTest : public testing::Test {
 protected:
  CaptureWatch watch(std::vector<std::string> sensors = {}, bool with_fit = false) const {
    return {{std::move(sensors), 10, with_fit, 0}, board_, kSlop, 0};
  }

  /// Returns whether it is news.
  bool say(const std::string& stage, const std::string& state, const std::string& scan_id, double at = 1,
           const std::string& code = "", double working = 0) {
    StageReport report;
    report.stage = stage;
    report.state = state;
    report.scan_id = scan_id;
    report.code = code;
    report.last_error = code.empty() ? "" : "because";
    report.working_seconds = working;
    return board_.report(report, at);
  }

  static std::string code(const CaptureWatch& watch, double now = 1) {
    const auto end = watch.end(now);
    return !end ? "under way" : end->code.empty() ? "well" : end->code;
  }

  StageBoard board_;
};

TEST_F(CaptureWatchTest, AScanThatWasMeasuredEndsWell) {
  CaptureWatch capture = watch();
  EXPECT_EQ(code(capture), "under way");
  capture.add_scan("a", 5 * kSecond);
  EXPECT_EQ(code(capture), "under way");
  capture.add_landmarks("before");
  EXPECT_EQ(code(capture), "under way");
  capture.add_landmarks("a");
  EXPECT_EQ(code(capture), "well");
  EXPECT_EQ(capture.scan_id(), "a");
}

TEST_F(CaptureWatchTest, WithFitItWaitsForTheGarment) {
  CaptureWatch capture = watch({}, true);
  capture.add_scan("a", 5 * kSecond);
  capture.add_landmarks("a");
  EXPECT_EQ(code(capture), "under way");
  capture.add_fit("before");
  EXPECT_EQ(code(capture), "under way");
  capture.add_fit("a");
  EXPECT_EQ(code(capture), "well");
}

TEST_F(CaptureWatchTest, MessagesMayOvertakeTheirScan) {
  CaptureWatch capture = watch();
  capture.add_landmarks("a");
  EXPECT_EQ(code(capture), "under way");
  capture.add_scan("a", 5 * kSecond);
  EXPECT_EQ(code(capture), "well");
}

TEST_F(CaptureWatchTest, EachSensorOfTheGoalMustHaveSeenThisScan) {
  CaptureWatch capture = watch({"left", "right"});
  capture.add_cloud("left", 5 * kSecond);
  capture.add_cloud("right", 2 * kSecond);  // of an earlier capture
  EXPECT_TRUE(capture.progress(1).missing.empty());
  capture.add_scan("a", 5 * kSecond);
  EXPECT_EQ(capture.progress(1).missing, std::vector<std::string>{"right"});
  capture.add_landmarks("a");
  EXPECT_EQ(code(capture), "missing_sensor");
  EXPECT_NE(capture.end(1)->message.find("without right"), std::string::npos);
  capture.add_cloud("right", 5 * kSecond + kSecond / 10);
  EXPECT_EQ(code(capture), "well");
}

TEST_F(CaptureWatchTest, CloudsOfTheScanThatCameBeforeTheGoalCount) {
  const std::vector<std::string> sensors = {"left", "right"};
  HeardSensors heard;
  CaptureWatch before = watch(sensors);
  heard.follow(sensors, 0, before);
  heard.add("left", 5 * kSecond, 99);
  heard.add("right", 3 * kSecond, 97);  // of the customer before
  heard.add("nobody", 5 * kSecond, 99);

  CaptureWatch capture = watch(sensors);
  heard.follow(sensors, 100, capture);
  EXPECT_EQ(capture.progress(101).missing, sensors) << "what came may be the customer's before";
  capture.add_scan("a", 5 * kSecond);
  capture.add_landmarks("a");
  EXPECT_EQ(capture.progress(101).missing, std::vector<std::string>{"right"});
  EXPECT_EQ(code(capture, 101), "missing_sensor");
  capture.add_cloud("right", 5 * kSecond);
  EXPECT_EQ(code(capture, 101), "well");
  EXPECT_EQ(capture.end(101)->message, "");
}

TEST_F(CaptureWatchTest, CloudsThatCameLongBeforeTheGoalAreAnothersWhoseScanIsLate) {
  const std::vector<std::string> sensors = {"left", "right"};
  HeardSensors heard;
  CaptureWatch before = watch(sensors);
  heard.follow(sensors, 0, before);
  heard.add("left", 5 * kSecond, 90);
  heard.add("right", 5 * kSecond, 89.5);
  const auto missing_of_a_goal_at = [&](double begins) {
    CaptureWatch capture = watch(sensors);
    heard.follow(sensors, begins, capture);
    capture.add_scan("a", 5 * kSecond);
    return capture.progress(102).missing;
  };
  EXPECT_EQ(missing_of_a_goal_at(99.5), std::vector<std::string>{});
  EXPECT_EQ(missing_of_a_goal_at(100), std::vector<std::string>{"right"});
  EXPECT_EQ(missing_of_a_goal_at(101), sensors);
}

TEST_F(CaptureWatchTest, OfASensorThatSendsAllTheTimeTheNewestCloudsAreKnown) {
  const std::vector<std::string> sensors = {"left"};
  HeardSensors heard;
  CaptureWatch before = watch(sensors);
  heard.follow(sensors, 0, before);
  for (std::uint64_t stamp = 1; stamp <= 1000; ++stamp) heard.add("left", stamp * kSecond, 99);
  for (const std::uint64_t stamp : {1, 1000}) {
    CaptureWatch capture = watch(sensors);
    heard.follow(sensors, 100, capture);
    capture.add_scan("a", stamp * kSecond);
    capture.add_landmarks("a");
    EXPECT_EQ(code(capture, 101), stamp == 1 ? "missing_sensor" : "well");
  }
}

TEST_F(CaptureWatchTest, OutOfTimeItNamesWhatIsMissing) {
  CaptureWatch capture = watch({"left", "right"});
  capture.add_cloud("left", kSecond);
  EXPECT_EQ(code(capture, 9.9), "under way");
  EXPECT_EQ(code(capture, 10), "missing_sensor");
  EXPECT_NE(capture.end(10)->message.find("waiting for right"), std::string::npos);

  CaptureWatch scanned = watch();
  EXPECT_EQ(code(scanned, 10), "timed_out");
  EXPECT_NE(scanned.end(10)->message.find("scan/points"), std::string::npos);
  scanned.add_scan("a", kSecond);
  EXPECT_NE(scanned.end(10)->message.find("waiting for reconstruction, which never reported"),
            std::string::npos);
  say("reconstruction", "done", "a", 8);
  say("landmarks", "working", "a", 5);
  EXPECT_EQ(code(scanned, 10), "timed_out");
  EXPECT_NE(scanned.end(10)->message.find("waiting for landmarks (landmarks is dead: silent for 5 s)"),
            std::string::npos);
}

TEST_F(CaptureWatchTest, AStageThatIsDeadIsAnEarlyAnswer) {
  const CaptureGoal patient{{}, 100, false, 0};
  CaptureWatch capture(patient, board_, kSlop, 0);
  say("reconstruction", "waiting", "", 9);
  say("landmarks", "waiting", "", 2);
  EXPECT_EQ(code(capture, 12), "under way") << "it may just be started again";
  EXPECT_EQ(code(capture, 12.1), "dead_stage");
  EXPECT_NE(capture.end(12.1)->message.find("landmarks is dead: silent for 10 s"), std::string::npos);
  say("landmarks", "waiting", "", 12.5);
  EXPECT_EQ(code(capture, 13), "under way") << "it was started again";

  capture.add_scan("a", kSecond);
  say("reconstruction", "done", "a", 14);
  say("landmarks", "working", "a", 25);
  EXPECT_EQ(code(capture, 30), "under way") << "what is over is not missed";
  say("reconstruction", "waiting", "", 40);
  say("landmarks", "waiting", "", 40);
  CaptureWatch dressed({{}, 100, true, 0}, board_, kSlop, 30);
  EXPECT_EQ(code(dressed, 41), "dead_stage") << "nobody heard of control_mesh";
  EXPECT_NE(dressed.end(41)->message.find("control_mesh is not running"), std::string::npos);
}

TEST_F(CaptureWatchTest, ARefusalOfTheScanIsTheAnswer) {
  say("landmarks", "refused", "before", 0, "not_a_body");
  CaptureWatch capture = watch();
  capture.add_scan("a", kSecond);
  say("control_mesh", "refused", "a", 1, "missing_part:bust");  // nobody asked for a fit
  EXPECT_EQ(code(capture), "under way");
  say("landmarks", "refused", "a", 1, "missing_part:crotch");
  EXPECT_EQ(code(capture), "missing_part:crotch");
}

TEST_F(CaptureWatchTest, ARefusalBeforeThereIsAScanCountsOnceAndOnlyWhenItIsNew) {
  EXPECT_TRUE(say("assembler", "refused", "1.0", 0, "missing_sensor"));
  EXPECT_FALSE(say("assembler", "refused", "1.0", 0.5, "missing_sensor"));  // says so again every second
  StageReport refused{"scan_player", "refused", "no_stamp: none", "1.0", false, "none", "no_stamp"};
  EXPECT_TRUE(board_.report(refused, 0));
  refused.last_error = "capture 0.5: a newer one came";
  refused.code = "superseded";
  EXPECT_FALSE(board_.report(refused, 0.5)) << "what it dropped since is no refusal";
  CaptureWatch capture = watch();
  EXPECT_EQ(code(capture), "under way");
  ASSERT_TRUE(say("assembler", "refused", "2.0", 1, "missing_sensor"));
  capture.add_refusal(*board_.find("assembler"));
  EXPECT_EQ(code(capture), "missing_sensor");

  CaptureWatch other = watch();
  ASSERT_TRUE(say("landmarks", "refused", "old", 1, "not_a_body"));  // of a scan that was under way
  other.add_refusal(*board_.find("landmarks"));
  EXPECT_EQ(code(other), "under way");
  ASSERT_TRUE(say("correlation", "refused", "old", 1, "other_pose"));  // of the customer before
  other.add_refusal(*board_.find("correlation"));
  EXPECT_EQ(code(other), "under way");
}

TEST_F(CaptureWatchTest, ARefusalOfWhatCameBeforeItWasAskedForIsNotItsEnd) {
  CaptureWatch capture({{}, 10, false, 5 * kSecond}, board_, kSlop, 0);
  ASSERT_TRUE(
      say("assembler", "refused", "4.900000000", 1, "missing_sensor"));  // of a capture that failed before
  capture.add_refusal(*board_.find("assembler"));
  EXPECT_EQ(code(capture), "under way");
  ASSERT_TRUE(say("assembler", "refused", "6.000000000", 1, "missing_sensor"));
  capture.add_refusal(*board_.find("assembler"));
  EXPECT_EQ(code(capture), "missing_sensor");
}

TEST_F(CaptureWatchTest, AScannerWithAnotherClockIsNamedAndOneWithoutIsTaken) {
  CaptureWatch capture({{}, 10, false, 5 * kSecond}, board_, kSlop, 0);
  capture.add_scan("a", 3 * kSecond);
  say("reconstruction", "waiting", "", 10);
  say("landmarks", "waiting", "", 10);
  ASSERT_EQ(code(capture, 10), "timed_out");
  EXPECT_NE(capture.end(10)->message.find("stamped 2.0 s"), std::string::npos) << capture.end(10)->message;
  capture.add_scan("b", 0);
  EXPECT_EQ(capture.scan_id(), "b");
  CaptureWatch asleep({{}, 10, false, kNever}, board_, kSlop, 0);  // its trigger was not pulled yet
  asleep.add_scan("c", 0);
  EXPECT_EQ(asleep.scan_id(), "");
}

TEST_F(CaptureWatchTest, ANewerScanEndsItAndAnOlderOneIsNotTaken) {
  CaptureWatch capture({{}, 10, false, 5 * kSecond}, board_, kSlop, 0);
  capture.add_scan("old", 4 * kSecond);
  EXPECT_EQ(capture.scan_id(), "");
  capture.add_scan("a", 5 * kSecond);
  capture.add_scan("a", 5 * kSecond);  // sent again
  EXPECT_EQ(code(capture), "under way");
  capture.add_scan("b", 6 * kSecond);
  capture.add_landmarks("a");
  EXPECT_EQ(code(capture), "superseded");
}

TEST_F(CaptureWatchTest, ProgressGoesThroughTheStagesAndNeverBack) {
  CaptureWatch capture = watch({"left", "right"}, true);
  std::vector<double> shares = {capture.progress(1).share};
  capture.add_cloud("left", kSecond);
  shares.push_back(capture.progress(1).share);
  capture.add_cloud("right", kSecond);
  EXPECT_EQ(capture.progress(1).stage, "assembler");
  shares.push_back(capture.progress(1).share);
  capture.add_scan("a", kSecond);
  say("reconstruction", "working", "a", 1, "", 1);
  EXPECT_EQ(capture.progress(1).stage, "reconstruction");
  shares.push_back(capture.progress(1).share);
  say("reconstruction", "done", "a");
  EXPECT_EQ(capture.progress(1).stage, "landmarks");
  shares.push_back(capture.progress(1).share);
  for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]) << i;
  say("reconstruction", "waiting", "", 1);  // started again
  EXPECT_EQ(capture.progress(1).stage, "reconstruction");
  EXPECT_EQ(capture.progress(1).share, shares.back());
  capture.add_landmarks("a");
  capture.add_fit("a");
  EXPECT_EQ(capture.progress(1).share, 1);
}

TEST_F(CaptureWatchTest, SlowIsNotDead) {
  say("reconstruction", "working", "a", 20, "", 12);
  say("landmarks", "working", "a", 20, "", 3);
  say("tffd", "done", "a", 16);
  EXPECT_EQ(board_.trouble(20), "reconstruction is slow: working for 12 s; tffd is dead: silent for 4 s");
}

}  // namespace
}  // namespace tensegric_fit::capture
