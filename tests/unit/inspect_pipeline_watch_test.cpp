#include "inspect/pipeline_watch.hpp"

#include <gtest/gtest.h>

#include "inspect/panel_words.hpp"

namespace tensegric_fit::inspect {
namespace {

void all_say(PipelineWatch& watch, const std::string& state, double now) {
  for (const char* stage : {"reconstruction", "landmarks", "control_mesh", "tensegric", "tffd"})
    watch.hear({stage, state, "", "one"}, now);
}

TEST(PipelineWatch, NothingHeardMeansNotRunning) {
  EXPECT_EQ(PipelineWatch().state(0).words, words::kPipelineNotRunning);
  EXPECT_TRUE(PipelineWatch().state(0).trouble);
}

TEST(PipelineWatch, SaysNothingOfStagesThatCannotHaveReportedYet) {
  PipelineWatch watch(100);
  EXPECT_EQ(watch.state(101).words, "");
  EXPECT_FALSE(watch.state(101).trouble);
  watch.hear({"reconstruction", "waiting", "", ""}, 101);
  EXPECT_EQ(watch.state(101).words, words::kWaitsForScan);
  EXPECT_FALSE(watch.state(101).trouble);
  watch.hear({"reconstruction", "waiting", "", ""}, 104);
  EXPECT_EQ(watch.state(104).words, words::silent("landmarks"));
  EXPECT_EQ(PipelineWatch(100).state(104).words, words::kPipelineNotRunning);
}

TEST(PipelineWatch, CountsTheStagesThatAreThroughWithTheNewestScan) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  EXPECT_EQ(watch.state(1).done, 5);
  EXPECT_EQ(watch.state(1).words, words::kReady);
  watch.hear({"reconstruction", "working", "", "two"}, 1);
  EXPECT_EQ(watch.state(1).done, 0);
  EXPECT_TRUE(watch.state(1).working);
  EXPECT_EQ(watch.state(1).newest_scan, "two") << "what is shown is not of it";
  watch.hear({"reconstruction", "done", "", "two"}, 2);
  EXPECT_EQ(watch.state(2).done, 1);
}

TEST(PipelineWatch, SlowIsNotDead) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"tensegric", "working", "", "one"}, 0);
  all_say(watch, "working", 60);  // the heartbeat goes on while it works
  EXPECT_FALSE(watch.state(60 + 0.9 * geometry::kSilent).trouble);
  EXPECT_TRUE(watch.state(60 + 1.1 * geometry::kSilent).trouble);
}

TEST(PipelineWatch, NamesTheStageThatDied) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  for (const char* stage : {"reconstruction", "landmarks", "control_mesh", "tffd"})
    watch.hear({stage, "done", "", "one"}, 10);
  EXPECT_EQ(watch.state(10).words, words::silent("tensegric"));
  watch.hear({"tensegric", "done", "", "one"}, 11);
  EXPECT_FALSE(watch.state(11).trouble);
  EXPECT_EQ(watch.state(60).words, words::kPipelineNotRunning);
}

TEST(PipelineWatch, AChainThatOnlyMeasuresIsReadyAndSaysSo) {
  PipelineWatch watch;
  watch.hear({"reconstruction", "done", "no_stamp: let the driver stamp it", "one", true}, 0);
  watch.hear({"landmarks", "working", "", "one"}, 0);
  EXPECT_FALSE(watch.state(0).trouble);
  EXPECT_EQ(watch.state(0).words, words::working("landmarks"));
  watch.hear({"landmarks", "done", "", "one"}, 1);
  const PipelineWatch::State state = watch.state(1);
  EXPECT_FALSE(state.trouble);
  EXPECT_EQ(state.done, state.all);
  EXPECT_EQ(state.words.find(words::kReadyToMeasure), 0u);
  EXPECT_NE(state.words.find("no_stamp"), std::string::npos) << "its warnings are said";
}

TEST(PipelineWatch, AStageThatNeverCameUpIsNamedWhereAnyThatFitsDid) {
  PipelineWatch watch;
  for (const char* stage : {"reconstruction", "landmarks", "tffd"}) watch.hear({stage, "done", "", "one"}, 0);
  EXPECT_EQ(watch.state(0).words, words::silent("control_mesh"));
  EXPECT_TRUE(watch.state(0).trouble);
  PipelineWatch without_landmarks;
  without_landmarks.hear({"reconstruction", "done", "", "one"}, 0);
  EXPECT_EQ(without_landmarks.state(0).words, words::silent("landmarks"));
}

TEST(PipelineWatch, WhatTheBoothNamesIsSaidToo) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"assembler", "refused", "late_cloud: played again", "9.0"}, 0);
  EXPECT_TRUE(watch.state(0).trouble);
  EXPECT_NE(watch.state(0).words.find("played again"), std::string::npos);
  watch.hear({"assembler", "done", "11 of 12 sensors came in time", "9.0", true}, 1);
  EXPECT_FALSE(watch.state(1).trouble);
  EXPECT_NE(watch.state(1).words.find("11 of 12 sensors"), std::string::npos);
  EXPECT_EQ(watch.state(1).words.find(words::kReady), 0u);
}

TEST(PipelineWatch, WhatIsDroppedIsNewsForAWhile) {
  PipelineWatch watch;
  const auto player = [](const std::string& error) {
    return StageReport{"scan_player", "done", "done", "a.ply", false, error};
  };
  all_say(watch, "done", 0);
  watch.hear(player("old.txt: no scan"), 0);  // of before the panel listened
  EXPECT_EQ(watch.state(0).words, words::kReady);
  watch.hear(player("notes.txt: no scan"), 1);
  EXPECT_NE(watch.state(1).words.find("notes.txt"), std::string::npos);
  EXPECT_TRUE(watch.state(1).trouble);
  all_say(watch, "done", 1.1 + PipelineWatch::kNews);
  watch.hear(player("notes.txt: no scan"), 1.1 + PipelineWatch::kNews);
  EXPECT_EQ(watch.state(1.1 + PipelineWatch::kNews).words, words::kReady);
}

TEST(PipelineWatch, AScanThatANewerOneOvertookIsNoNews) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  StageReport report{"reconstruction", "working", "", "three"};
  report.last_error = "a newer scan came before scan two was done";
  report.code = "superseded";
  watch.hear(report, 1);
  EXPECT_FALSE(watch.state(1.1).trouble);
  EXPECT_TRUE(watch.state(1.1).working);
}

TEST(PipelineWatch, WhatTheBoothRefusedIsShownUntilTheNextScan) {
  PipelineWatch watch;
  const StageReport refused{"scan_player", "refused", "b.ply: broken", "b.ply"};
  all_say(watch, "done", 0);
  for (const double now : {1.0, 2.0, 3.0}) {
    all_say(watch, "done", now);
    watch.hear(refused, now);
    EXPECT_NE(watch.state(now).words.find("b.ply"), std::string::npos);
    EXPECT_EQ(watch.state(now).newest_scan, "b.ply") << "the body that is shown is not hers";
  }
  for (const char* stage : {"reconstruction", "landmarks", "control_mesh", "tensegric", "tffd"})
    watch.hear({stage, "done", "done", "next"}, 4);
  watch.hear(refused, 4);  // it says so once a second, and has played nothing since
  EXPECT_EQ(watch.state(4).words, words::kReady);
  EXPECT_EQ(watch.state(4).newest_scan, "next");
  EXPECT_FALSE(watch.state(4).trouble);
  watch.hear({"scan_player", "refused", "c.ply: broken", "c.ply"}, 4.5);
  EXPECT_NE(watch.state(4.5).words.find("c.ply"), std::string::npos);
}

TEST(PipelineWatch, TheNewestScanIsNotForgottenWhereStagesEndOrComeBack) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"reconstruction", "refused", "not_a_body", "two"}, 1);
  EXPECT_EQ(watch.state(1).newest_scan, "two");
  EXPECT_EQ(watch.state(60).newest_scan, "two") << "nothing lives";
  watch.hear({"reconstruction", "waiting", "", ""}, 61);
  EXPECT_EQ(watch.state(61).newest_scan, "two") << "one that came back has no scan yet";
  watch.hear({"scan_player", "refused", "c.ply: broken", "c.ply"}, 62);
  watch.hear({"scan_player", "waiting", "", ""}, 63);
  EXPECT_EQ(watch.state(63).newest_scan, "c.ply");
  watch.hear({"reconstruction", "working", "", "four"}, 64);
  EXPECT_EQ(watch.state(64).newest_scan, "four");
}

TEST(PipelineWatch, ABodyThatCamePastReconstructionIsTheNewest) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"scan_player", "refused", "b.ply: broken", "b.ply"}, 0.5);
  watch.hear({"landmarks", "working", "", "lone"}, 1);
  EXPECT_EQ(watch.state(1).newest_scan, "lone");
  for (const char* stage : {"landmarks", "control_mesh", "tensegric", "tffd"})
    watch.hear({stage, "done", "", "lone"}, 2);
  watch.hear({"reconstruction", "done", "", "one"}, 2);  // it says so once a second
  EXPECT_EQ(watch.state(2).newest_scan, "lone");
  EXPECT_EQ(watch.state(2).words, words::kReady);
  EXPECT_EQ(watch.state(2).done, watch.state(2).all);
  watch.hear({"landmarks", "working", "", "one"}, 3);  // latched, and delivered again to one that came back
  EXPECT_EQ(watch.state(3).newest_scan, "lone") << "reconstruction made it before";
  watch.hear({"reconstruction", "working", "", "two"}, 4);
  watch.hear({"landmarks", "done", "", "one"}, 4);
  EXPECT_EQ(watch.state(4).newest_scan, "two");
  watch.hear({"reconstruction", "refused", "not_a_body", "two"}, 5);
  EXPECT_EQ(watch.state(5).newest_scan, "two");
  watch.hear({"landmarks", "working", "", "lone"}, 6);
  EXPECT_EQ(watch.state(6).newest_scan, "lone") << "it came after the scan that was refused";

  PipelineWatch without_scans;
  without_scans.hear({"reconstruction", "waiting", "", ""}, 0);
  without_scans.hear({"landmarks", "done", "", "lone"}, 0);
  EXPECT_EQ(without_scans.state(0).newest_scan, "lone");
}

TEST(PipelineWatch, WhereTheLandmarksComeLateReconstructionsScanIsTheNewest) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"reconstruction", "working", "", "two"}, 1);
  watch.hear({"reconstruction", "refused", "empty_cloud", "three"}, 2);  // it came while two was worked on
  watch.hear({"reconstruction", "done", "", "two"}, 3);
  watch.hear({"reconstruction", "refused", "empty_cloud", "three"}, 3);
  watch.hear({"landmarks", "working", "", "two"}, 3);
  EXPECT_EQ(watch.state(3).newest_scan, "three");
  watch.hear({"landmarks", "done", "", "two"}, 4);
  EXPECT_EQ(watch.state(4).newest_scan, "three");

  PipelineWatch joined;
  joined.hear({"reconstruction", "working", "", "two"}, 0);
  joined.hear({"landmarks", "done", "", "one"}, 0);
  EXPECT_EQ(joined.state(0).newest_scan, "two");
  joined.hear({"landmarks", "waiting", "", ""}, 1);  // it has come back
  joined.hear({"landmarks", "working", "", "one"}, 1);
  EXPECT_EQ(joined.state(1).newest_scan, "two");
}

TEST(PipelineWatch, CamerasThatDiedAreNamed) {
  PipelineWatch watch;
  watch.hear({"depth_cameras", "waiting", "", ""}, 0);
  all_say(watch, "done", 0);
  EXPECT_EQ(watch.state(0).words, words::kReady);
  all_say(watch, "done", 10);
  EXPECT_EQ(watch.state(10).words, words::silent("depth_cameras"));
  EXPECT_TRUE(watch.state(10).trouble);
  for (const char* stage : {"reconstruction", "landmarks", "control_mesh", "tensegric", "tffd"})
    watch.hear({stage, "done", "", "two"}, 11);
  EXPECT_EQ(watch.state(11).words, words::kReady) << "a scan came without it";
}

TEST(PipelineWatch, WarningsOfTheScanThatIsShownAreSaidAndOfNoOther) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"reconstruction", "done", "no_stamp: let the driver stamp it", "one", true}, 0);
  EXPECT_NE(watch.state(0).words.find("no_stamp"), std::string::npos);
  watch.hear({"landmarks", "done", "of the scan before", "one", true}, 0);
  watch.hear({"reconstruction", "done", "", "two"}, 1);
  EXPECT_FALSE(watch.state(1).trouble || watch.state(1).working);
  EXPECT_EQ(watch.state(1).words.find("of the scan before"), std::string::npos);
}

TEST(PipelineWatch, SaysWhatWasRefused) {
  PipelineWatch watch;
  all_say(watch, "done", 0);
  watch.hear({"reconstruction", "refused", "empty_cloud: no points at all", "two"}, 0);
  EXPECT_NE(watch.state(0).words.find("no points at all"), std::string::npos);
  EXPECT_TRUE(watch.state(0).trouble);
}

}  // namespace
}  // namespace tensegric_fit::inspect
