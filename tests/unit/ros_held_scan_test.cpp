/// What a node answers to `forget` while its worker is at it. The order of the calls is that of Stage.
#include <gtest/gtest.h>

#include "ros/held_scan.hpp"

namespace tensegric_fit::node {
namespace {

class HeldScanTest : public testing::Test {
 protected:
  /// A scan has come, and work on it waits.
  void take(const std::string& scan_id) {
    held_.begin(scan_id);
    held_.wait(scan_id);
  }

  void do_work(const std::string& scan_id) {
    held_.work(scan_id);
    held_.publish(scan_id);
    held_.rest();
  }

  HeldScan held_;
};

/// Once answered with "nothing held" while it was published, and latched afterwards.
TEST_F(HeldScanTest, AScanIsHeldWhileItIsWorkedOnThoughANewerOneHasCome) {
  take("b");
  held_.work("b");
  take("c");
  EXPECT_TRUE(held_.holds("b"));
  EXPECT_TRUE(held_.must_finish("b")) << "c would be lost";
  held_.publish("b");
  held_.rest();
  EXPECT_TRUE(held_.holds("b")) << "it is latched";
  EXPECT_TRUE(held_.must_finish("b")) << "c waits";
  do_work("c");
  EXPECT_FALSE(held_.must_finish("b"));
  EXPECT_FALSE(held_.holds("b"));
  EXPECT_TRUE(held_.holds("c"));
}

TEST_F(HeldScanTest, AScanWhoseWorkFailedIsHeldUntilAnotherTakesItsPlace) {
  take("a");
  held_.work("a");
  held_.rest();  // refused: the worker keeps what it was given
  take("b");
  EXPECT_TRUE(held_.holds("a"));
  do_work("b");
  EXPECT_FALSE(held_.holds("a"));
}

/// A stage may still have what came of the first: nothing of that kind has come since. One that publishes
/// nothing, as correlation without a worn scan, starts afresh with every scan that is to be forgotten.
TEST_F(HeldScanTest, AllScansAreHeldSinceSomethingWasPublished) {
  for (const char* scan_id : {"a", "b", "c", "d", "e", "f", "g"}) held_.begin(scan_id);
  EXPECT_TRUE(held_.holds("a"));
  take("h");
  do_work("h");
  EXPECT_FALSE(held_.holds("a"));
}

TEST_F(HeldScanTest, SecondScansAreHeldUntilANewStart) {
  do_work("a");
  held_.begin_beside("worn");
  EXPECT_TRUE(held_.holds("worn"));
  held_.work("a");
  held_.begin_beside("worn too");
  held_.publish("a");
  held_.rest();
  EXPECT_TRUE(held_.holds("worn")) << "its result is latched";
  EXPECT_TRUE(held_.holds("worn too"));
  held_.clear();
  EXPECT_FALSE(held_.holds("worn"));
  EXPECT_FALSE(held_.holds("worn too"));
}

TEST_F(HeldScanTest, AScanIsHeldUntilAnotherTakesItsPlaceThoughWorkOnItWasDropped) {
  take("b");
  held_.work("b");
  held_.begin("c");
  EXPECT_TRUE(held_.holds("b"));
  EXPECT_TRUE(held_.must_finish("b"));
  held_.rest();
  EXPECT_FALSE(held_.must_finish("b"));
  EXPECT_TRUE(held_.holds("b"));
  do_work("c");
  EXPECT_FALSE(held_.holds("b"));
}

/// The topics of a scan whose others were refused elsewhere are kept until all of another's have come.
TEST_F(HeldScanTest, AScanThatNoWorkBeganOnIsHeldUntilAnotherTakesItsPlace) {
  held_.begin("a");
  held_.begin("b");
  EXPECT_TRUE(held_.holds("a"));
  held_.wait("b");
  do_work("b");
  EXPECT_FALSE(held_.holds("a"));
}

/// Its folder was once there after `forget` had deleted all exports of it.
TEST_F(HeldScanTest, AScanIsHeldWhileAnExportOfItIsWritten) {
  do_work("a");
  do_work("b");
  {
    const HeldScan::Export first(held_, "a"), second(held_, "a");
    EXPECT_TRUE(held_.holds("a"));
    EXPECT_TRUE(held_.must_finish("a"));
    EXPECT_FALSE(held_.must_finish("b"));
    EXPECT_TRUE(held_.is_busy());
  }
  EXPECT_FALSE(held_.is_busy());
  EXPECT_FALSE(held_.holds("a"));
  EXPECT_FALSE(held_.must_finish("a"));
}

/// Once thrown away where the order came before the worker had begun it.
TEST_F(HeldScanTest, WorkThatWaitsIsNotLostForAnotherScan) {
  take("a");
  do_work("a");
  EXPECT_FALSE(held_.must_finish("a"));
  take("b");
  EXPECT_TRUE(held_.holds("a"));
  EXPECT_TRUE(held_.must_finish("a"));
  EXPECT_FALSE(held_.must_finish("b")) << "work on the scan itself need not be finished";
  do_work("b");
  EXPECT_FALSE(held_.holds("a"));
}

TEST_F(HeldScanTest, NothingIsHeldAfterANewStartButWhatIsForgottenStaysSo) {
  take("a");
  held_.work("a");
  held_.publish("a");
  take("b");
  held_.forget("a");
  held_.clear();
  EXPECT_FALSE(held_.holds("a"));
  EXPECT_FALSE(held_.holds("b"));
  EXPECT_FALSE(held_.must_finish("a"));
  EXPECT_TRUE(held_.is_forgotten("a"));
  EXPECT_FALSE(held_.is_forgotten("b"));
}

}  // namespace
}  // namespace tensegric_fit::node
