/// When a message counts as lost. The clock is the test's own.
#include <gtest/gtest.h>

#include "ros/lost_messages.hpp"

namespace tensegric_fit::node {
namespace {

using Advice = LostMessages::Advice;

TEST(LostMessages, OneThatComesIsNotLost) {
  LostMessages input;
  EXPECT_EQ(input.advice(0), Advice::wait);
  input.sent("a", 10);
  EXPECT_EQ(input.advice(10), Advice::wait);
  input.heard("a");
  EXPECT_EQ(input.advice(1000), Advice::wait);
}

TEST(LostMessages, OneThatOvertakesItsReportIsNotLost) {
  LostMessages input;
  input.heard("a");
  input.sent("a", 10);
  EXPECT_EQ(input.advice(1000), Advice::wait);
}

TEST(LostMessages, ItConnectsAnewAndGivesUpOnce) {
  LostMessages input;
  input.sent("a", 10);
  EXPECT_EQ(input.advice(11.9), Advice::wait);
  EXPECT_EQ(input.advice(12), Advice::connect_anew);
  input.sent("a", 12.5);  // stages repeat themselves once a second
  EXPECT_EQ(input.advice(13.9), Advice::wait);
  EXPECT_EQ(input.advice(14), Advice::give_up);
  EXPECT_EQ(input.advice(1000), Advice::wait);
}

TEST(LostMessages, AnotherScanBeginsAnew) {
  LostMessages input;
  input.heard("a");
  input.sent("b", 10);
  EXPECT_EQ(input.advice(12), Advice::connect_anew);
  EXPECT_EQ(input.advice(14), Advice::give_up);
  input.sent("c", 20);
  EXPECT_EQ(input.advice(21), Advice::wait);
  input.heard("b");  // late, and of the scan before
  EXPECT_EQ(input.advice(22), Advice::connect_anew);
  input.heard("c");
  input.heard("b");
  EXPECT_EQ(input.advice(24), Advice::wait);
}

TEST(LostMessages, AMessageThatTheNextScansOvertookIsKnown) {
  LostMessages input;
  input.sent("a", 10);
  input.sent("b", 20);
  EXPECT_FALSE(input.is_overtaken("a"));  // better than nothing
  input.heard("b");
  EXPECT_TRUE(input.is_overtaken("a"));
  EXPECT_FALSE(input.is_overtaken("b"));
  EXPECT_FALSE(input.is_overtaken("c"));  // the next may be faster than its report
  input.sent("a", 30);                    // done once more
  EXPECT_FALSE(input.is_overtaken("a"));
}

TEST(LostMessages, AStateOnTheWayToAResultThatHasComeIsLate) {
  LostMessages input;
  input.working("a");
  EXPECT_FALSE(input.is_late("a"));
  input.heard("a");
  EXPECT_TRUE(input.is_late("a"));
  EXPECT_FALSE(input.is_late("b"));
  input.sent("a", 10);
  EXPECT_TRUE(input.is_late("a"));
  input.working("a");  // another garment
  EXPECT_FALSE(input.is_late("a"));
  input.heard("a");
  EXPECT_TRUE(input.is_late("a"));
}

TEST(LostMessages, NothingIsLateOfAStageThatDoesNotReport) {
  LostMessages input;
  input.heard("a");
  EXPECT_FALSE(input.is_late("a"));
}

}  // namespace
}  // namespace tensegric_fit::node
