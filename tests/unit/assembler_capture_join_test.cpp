#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "assembler/capture_join.hpp"
#include "assembler/capture_queue.hpp"
#include "assembler/shared_frames.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit {
namespace {

using assembler::Capture;
using assembler::CaptureJoin;
using Fate = CaptureJoin::Fate;

constexpr std::uint64_t kSecond = 1000000000, kStart = 1700000000 * kSecond;

/// The stamp is `at` seconds after the start.
std::shared_ptr<const assembler::SensorCloud> cloud(double at, const std::string& frame_id = "") {
  const auto stamp = kStart + static_cast<std::uint64_t>(std::llround(1e9 * at));
  return std::make_shared<const assembler::SensorCloud>(assembler::SensorCloud{stamp, frame_id, {}});
}

TEST(CaptureJoinTest, ACaptureLeavesOnceWithTheCloudsOfAllSensors) {
  CaptureJoin join(3, {0.1, 2.0});
  EXPECT_EQ(join.add(2, cloud(0.05), 0), Fate::taken);
  EXPECT_EQ(join.add(0, cloud(0.00), 0.1), Fate::taken);
  EXPECT_FALSE(join.next(0.1));
  EXPECT_EQ(join.add(1, cloud(0.10), 0.2), Fate::taken);
  const std::optional<Capture> capture = join.next(0.2);
  ASSERT_TRUE(capture);
  EXPECT_TRUE(capture->missing().empty());
  EXPECT_EQ(capture->first, kStart);
  EXPECT_EQ(capture->last, kStart + kSecond / 10);
  EXPECT_EQ(capture->clouds[2]->stamp, kStart + kSecond / 20);
  EXPECT_FALSE(join.next(100));
}

TEST(CaptureJoinTest, AMissingSensorIsNamedWhenTheTimeIsUp) {
  CaptureJoin join(3, {0.1, 2.0});
  join.add(0, cloud(0), 10);
  join.add(2, cloud(0), 11);
  EXPECT_FALSE(join.next(11.99));
  const std::optional<Capture> capture = join.next(12);
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->missing(), std::vector<int>{1});
  EXPECT_EQ(join.add(1, cloud(0.01), 12.5), Fate::late);
  EXPECT_FALSE(join.next(100));
}

TEST(CaptureJoinTest, CloudsOfTwoCapturesThatCrossEachOtherAreNotMixed) {
  CaptureJoin join(2, {0.1, 2.0});
  join.add(0, cloud(0), 0);
  join.add(0, cloud(1), 0);  // of the second capture, before the first one is complete
  join.add(1, cloud(1), 0);
  const std::optional<Capture> first = join.next(0), second = join.next(0);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->missing(), std::vector<int>{1});  // overtaken
  EXPECT_TRUE(second->missing().empty());
  EXPECT_EQ(second->first, kStart + kSecond);
  EXPECT_EQ(join.add(1, cloud(0.02), 0.1), Fate::late);
  EXPECT_FALSE(join.next(100));
}

/// That saw something.
std::shared_ptr<const assembler::SensorCloud> seen(double at) {
  auto sent = *cloud(at);
  sent.cloud.points = {Eigen::Vector3d::Zero()};
  return std::make_shared<const assembler::SensorCloud>(sent);
}

TEST(CaptureJoinTest, ACaptureOfTooFewSensorsKeepsNoLaterOneBack) {
  CaptureJoin join(2, {0.1, 2.0, 2});
  join.add(0, seen(59), 0);  // its clock was ahead
  const std::optional<Capture> ahead = join.next(2);
  ASSERT_TRUE(ahead);
  EXPECT_FALSE(ahead->is_stray);
  EXPECT_EQ(join.add(1, seen(59.05), 2.1), Fate::late) << "its own late cloud";
  EXPECT_EQ(join.add(0, seen(10), 10), Fate::taken);
  EXPECT_EQ(join.add(1, seen(10), 10), Fate::taken);
  EXPECT_TRUE(join.next(10));
  EXPECT_EQ(join.add(0, seen(59), 11), Fate::played);
  EXPECT_EQ(join.add(0, seen(59.02), 59), Fate::taken);
  EXPECT_EQ(join.add(1, seen(59.02), 59), Fate::taken);
  EXPECT_TRUE(join.next(59));
}

TEST(CaptureJoinTest, ACaptureOfTooFewSensorsPushesNoOlderOneOut) {
  CaptureJoin join(3, {0.1, 2.0, 3});
  join.add(0, seen(59), 0);
  join.add(0, seen(2), 1.9);
  join.add(1, seen(2), 1.9);
  EXPECT_EQ(join.next(2)->first, kStart + 59 * kSecond);
  EXPECT_FALSE(join.next(2));
  join.add(2, seen(2), 2.1);
  EXPECT_TRUE(join.next(2.1)->missing().empty());
}

TEST(CaptureJoinTest, ASensorWithAnotherClockIsNamedNotTheOthers) {
  const std::vector<std::string> topics{"a", "b", "c"};
  for (const double off : {-1.0, 1.0, 40.0})
    for (const int enough : {2, 3}) {
      CaptureJoin join(3, {0.1, 2.0, enough});
      join.add(0, seen(100), 0);
      join.add(1, seen(100 + off), 0.01);
      join.add(2, seen(100), 0.02);
      std::vector<Capture> left;
      for (const double now : {1.0, 2.0, 2.015, 2.02, 3.0})
        while (const auto capture = join.next(now)) left.push_back(*capture);
      ASSERT_EQ(left.size(), 2u);
      for (const Capture& capture : left) {
        EXPECT_EQ(capture.is_stray, capture.seeing() == 1);
        ASSERT_EQ(capture.other_clocks.size(), 1u) << off << " " << enough;
        EXPECT_EQ(words_of(capture.other_clocks[0], topics),
                  off == -1  ? "b is stamped 1.0 s before the others: are clocks set alike?"
                  : off == 1 ? "b is stamped 1.0 s after the others: are clocks set alike?"
                             : "b is stamped 40.0 s after the others: are clocks set alike?");
      }
    }
}

// Its stamp was that of the next customer's capture, whose other sensors were all kept back.
TEST(CaptureJoinTest, ACloudOfAnotherClockKeepsNoNextCaptureBack) {
  CaptureJoin join(3, {0.1, 2.0, 2});
  join.add(0, seen(100), 0);
  join.add(1, seen(103), 0.01);
  join.add(2, seen(100), 0.02);
  bool stray = false;
  for (const double now : {2.0, 2.02})
    while (const auto capture = join.next(now)) stray = stray || capture->is_stray;
  EXPECT_TRUE(stray);
  EXPECT_EQ(join.add(0, seen(103), 3), Fate::taken);
  EXPECT_EQ(join.add(2, seen(103), 3), Fate::taken);
  EXPECT_TRUE(join.next(5.1));
}

TEST(CaptureJoinTest, ASensorThatSawNothingIsBlind) {
  CaptureJoin join(3, {0.1, 2.0, 3});
  join.add(0, seen(0), 0);
  join.add(1, cloud(0), 0);
  auto black = *seen(0);
  black.cloud.points = {Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  join.add(2, std::make_shared<const assembler::SensorCloud>(black), 0);
  const std::optional<Capture> capture = join.next(0);  // nothing to wait for
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->blind(), (std::vector<int>{1, 2}));
  EXPECT_EQ(capture->seeing(), 1);
}

TEST(CaptureJoinTest, ASensorThatFiresTwiceWithinTheSlopBeginsAnotherCapture) {
  CaptureJoin join(2, {0.5, 2.0});
  join.add(0, cloud(0), 0);
  EXPECT_EQ(join.add(0, cloud(0), 0), Fate::repeated);
  EXPECT_EQ(join.add(0, cloud(0.3), 0), Fate::taken);
  join.add(1, cloud(0.31), 0);  // nearer to the second one
  join.add(1, cloud(0.01), 0);
  const std::optional<Capture> first = join.next(0), second = join.next(0);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->last, kStart + kSecond / 100);
  EXPECT_EQ(second->first, kStart + 3 * kSecond / 10);
  EXPECT_EQ(join.add(1, cloud(0.31), 0), Fate::played);
}

TEST(CaptureJoinTest, ARecordingPlayedAgainIsSaidForEverySensor) {
  constexpr int kSensors = 12;
  CaptureJoin join(kSensors, {0.2, 2.0});
  for (int sensor = 0; sensor < kSensors; ++sensor)
    EXPECT_EQ(join.add(sensor, cloud(0.01 * sensor), 0), Fate::taken);
  ASSERT_TRUE(join.next(0));
  for (int sensor = 0; sensor < kSensors; ++sensor)
    EXPECT_EQ(join.add(sensor, cloud(0.01 * sensor), 30), Fate::played);
  EXPECT_FALSE(join.next(100));
}

TEST(CaptureJoinTest, NoPointsAreKeptOfACaptureThatHasLeft) {
  CaptureJoin join(1, {0.2, 2.0});
  auto sent = cloud(0);
  const std::weak_ptr<const assembler::SensorCloud> points = sent;
  join.add(0, std::move(sent), 0);
  EXPECT_TRUE(join.next(0).value().clouds[0] == points.lock());
  EXPECT_TRUE(points.expired());
  EXPECT_EQ(join.add(0, cloud(0), 1), Fate::played);
}

TEST(CaptureJoinTest, ARecordingThatStartsOverIsTakenAgain) {
  CaptureJoin join(2, {0.1, 2.0});
  for (const double at : {0.0, 100.0, 0.0}) {
    EXPECT_EQ(join.add(0, cloud(at), 0), Fate::taken) << at;
    EXPECT_EQ(join.add(1, cloud(at), 0), Fate::taken) << at;
    EXPECT_TRUE(join.next(0)) << at;
  }
}

TEST(CaptureJoinTest, MemoryIsBoundedWhereNoCaptureIsEverComplete) {
  CaptureJoin join(2, {0.1, 600});
  int left = 0;
  for (int i = 0; i < 1000; ++i) {
    join.add(0, cloud(i), 0);
    while (join.next(0)) ++left;
  }
  EXPECT_GE(left, 990);
}

TEST(CaptureJoinTest, WhateverComesWhenNothingIsMixedAndNothingComesTwice) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    struct Arrival {
      double time;
      int sensor, of;
      double stamp;
    };
    std::vector<Arrival> arrivals;
    for (int of = 0; of < 12; ++of)
      for (int sensor = 0; sensor < 4; ++sensor)
        if (unit(random) < 0.9) {
          const double stamp = of + 0.1 * unit(random);
          arrivals.push_back({stamp + 3 * unit(random) * unit(random), sensor, of, stamp});
        }
    std::sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    CaptureJoin join(4, {0.1, 1.5});
    int taken = 0, given = 0, last = -1;
    const auto leave = [&](double now) {
      while (const std::optional<Capture> capture = join.next(now)) {
        EXPECT_LE(capture->last - capture->first, kSecond / 10) << seed;
        std::string of;
        for (const auto& sent : capture->clouds) {
          if (!sent) continue;
          ++given;
          if (!of.empty()) {
            EXPECT_EQ(sent->frame_id, of) << seed;
          }
          of = sent->frame_id;
        }
        EXPECT_GT(std::stoi(of), last) << seed;
        last = std::stoi(of);
      }
    };
    for (const Arrival& arrival : arrivals) {
      leave(arrival.time);
      taken += join.add(arrival.sensor, cloud(arrival.stamp, std::to_string(arrival.of)), arrival.time) ==
               Fate::taken;
    }
    leave(100);
    EXPECT_EQ(given, taken) << seed;
  }
}

TEST(CaptureJoinTest, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(CaptureJoin(2, {-1, 2}), geometry::Refusal);
  EXPECT_THROW(CaptureJoin(2, {0.1, 0}), geometry::Refusal);
  EXPECT_THROW(CaptureJoin(2, {std::numeric_limits<double>::quiet_NaN(), 2}), geometry::Refusal);
}

TEST(CaptureQueueTest, WhileOneIsAssembledTheNewestOfTheOthersWaits) {
  assembler::CaptureQueue queue;
  // the stamp of what made room; 0: nothing did
  const auto put = [&queue](std::uint64_t stamp) {
    const auto replaced = queue.put({stamp, stamp, {}}, "some warning");
    return replaced ? replaced->capture.first : std::uint64_t{0};
  };
  EXPECT_FALSE(queue.next());
  EXPECT_EQ(put(1), 0u);
  std::shared_ptr<const assembler::CaptureTurn> turn = queue.next();
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->capture.first, 1u);
  EXPECT_EQ(turn->warning, "some warning");
  EXPECT_EQ(turn->left_out, 0);
  for (const std::uint64_t stamp : {2, 3, 4}) {
    EXPECT_EQ(put(stamp), stamp == 2 ? 0 : stamp - 1) << "the one at work makes no room";
    EXPECT_FALSE(queue.next()) << stamp;
  }
  turn.reset();  // published, refused, or dropped
  turn = queue.next();
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->capture.first, 4u);
  EXPECT_EQ(turn->left_out, 2);
  EXPECT_EQ(put(5), 0u);
  turn.reset();
  turn = queue.next();
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->capture.first, 5u);
  EXPECT_EQ(turn->left_out, 0);
  turn.reset();
  EXPECT_FALSE(queue.next());
}

TEST(SharedFramesTest, AFrameOfSeveralCloudsAndTheBoothsAreNoViewpoints) {
  const auto shared_in = [](const std::vector<std::string>& frames, const std::string& scan_frame = "booth") {
    Capture capture{kStart, kStart, {nullptr}};  // the first sensor is missing
    for (const std::string& frame : frames) capture.clouds.push_back(cloud(0, frame));
    return assembler::warning_of(assembler::shared_frames(capture, scan_frame), {"0", "1", "2", "3", "4"});
  };
  const std::string end = ": where their sensors stood is unknown, normals are left out";
  EXPECT_EQ(shared_in({"left", "right", "back"}), "");
  EXPECT_EQ(shared_in({"left", "booth", "back"}), "clouds of 2 are in the scan's own frame (booth)" + end);
  EXPECT_EQ(shared_in({"left", "right", "left"}), "clouds of 1 and 3 are in one frame (left)" + end);
  EXPECT_EQ(
      shared_in({"left", "left", "left", "booth"}),
      "clouds of 4 are in the scan's own frame (booth), clouds of 1, 2 and 3 are in one frame (left)" + end);
  EXPECT_EQ(shared_in({"left", "shop/booth"}, "shop/booth"),
            "clouds of 2 are in the scan's own frame (shop/booth)" + end);
  EXPECT_EQ(shared_in({"left", "right"}, "left"), "") << "calibrated relative to that sensor";
  EXPECT_EQ(shared_in({"left", "photobooth"}, "photobooth"), "");
  EXPECT_EQ(shared_in({"left", "right", "left"}, "left"),
            "clouds of 1 and 3 are in the scan's own frame (left)" + end);
}

}  // namespace
}  // namespace tensegric_fit
