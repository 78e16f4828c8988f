#include "inspect/fit_session.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tensegric_fit::inspect {
namespace {

FitSession both_worn() {
  FitSession session;
  session.adopt("B1+H1", {{"chest", 0.95, ""}, {"hip", 0.97, ""}});
  session.place({{"chest", "bust"}, {"hip", "hips"}});
  return session;
}

double ratio_of(const FitSession& session, const std::string& name) {
  for (const AskedLine& line : session.now().lines)
    if (line.name == name) return line.ratio;
  return 0;
}

TEST(FitSession, ADraggedSliderIsOneStepBack) {
  FitSession session = both_worn();
  for (const double ratio : {0.94, 0.93, 0.92}) EXPECT_TRUE(session.ask("chest", ratio));
  session.settle();
  EXPECT_TRUE(session.ask("chest", 0.90));
  EXPECT_TRUE(session.undo());
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), 0.92);
  EXPECT_TRUE(session.undo());
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), 0.95);
  EXPECT_FALSE(session.undo());
}

TEST(FitSession, NonsenseIsBroughtWithinLimitsOrIgnored) {
  FitSession session = both_worn();
  EXPECT_TRUE(session.ask("chest", -3));
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), FitSession::kLeast);
  EXPECT_TRUE(session.ask("chest", 1e9));
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), FitSession::kMost);
  EXPECT_FALSE(session.ask("chest", std::nan("")));
  EXPECT_FALSE(session.ask("sleeve", 0.9));
  EXPECT_FALSE(FitSession().ask("chest", 0.9));
}

TEST(FitSession, OneRegionStaysOn) {
  FitSession session = both_worn();
  EXPECT_EQ(session.now().regions(), (std::vector<std::string>{"bust", "hips"}));
  EXPECT_TRUE(session.switch_region("hips", false));
  ASSERT_EQ(session.now().worn().size(), 1u);
  EXPECT_EQ(session.now().worn()[0].name, "chest");
  EXPECT_FALSE(session.switch_region("bust", false));
  EXPECT_FALSE(session.switch_region("sleeves", false));
  EXPECT_TRUE(session.undo());
  EXPECT_EQ(session.now().worn().size(), 2u);
}

TEST(FitSession, FollowsWhatSomebodyElseAsksFor) {
  FitSession session = both_worn();
  session.adopt("B1+H1", {{"chest", 0.95, ""}, {"hip", 0.97, ""}});  // its own echo
  EXPECT_FALSE(session.can_undo());
  session.adopt("B1+H1", {{"chest", 0.91, ""}});  // another panel: ratio changed, hips off
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), 0.91);
  EXPECT_EQ(session.now().off, std::set<std::string>{"hips"});
  session.adopt("B1+H1", {{"chest", 0.91, ""}, {"hip", 0.97, ""}});
  EXPECT_TRUE(session.now().off.empty());
  session.adopt("B2", {{"strap", std::nan(""), ""}});
  EXPECT_EQ(session.now().garment, "B1+H1");
  session.adopt("B2", {{"strap", 0.9, ""}});
  EXPECT_EQ(session.now().lines.size(), 1u);
  EXPECT_TRUE(session.undo());
  EXPECT_EQ(session.now().garment, "B1+H1");
}

TEST(FitSession, LengthsAreThoseOfTheGarmentWorn) {
  FitSession session = both_worn();
  EXPECT_EQ(session.length("chest"), 0);
  session.set_length("chest", 0.4);
  session.set_length("hip", std::nan(""));
  EXPECT_EQ(session.length("chest"), 0.4);
  EXPECT_EQ(session.length("hip"), 0);
  session.adopt("B2", {{"strap", 0.9, ""}});
  EXPECT_EQ(session.length("chest"), 0);
}

TEST(FitSession, SidesGoTogetherUntilTheyAreParted) {
  FitSession session;
  session.adopt("B2", {{"strap_L", 0.95, ""}, {"strap_R", 0.95, ""}, {"chest", 0.9, ""}});
  EXPECT_TRUE(session.has_pairs());
  EXPECT_TRUE(session.ask("strap_R", 0.9));
  EXPECT_EQ(session.now().lines[0].ratio, 0.9);
  EXPECT_EQ(session.now().lines[1].ratio, 0.9);
  EXPECT_EQ(session.now().lines[2].ratio, 0.9);
  EXPECT_TRUE(session.undo());
  EXPECT_EQ(session.now().lines[0].ratio, 0.95) << "one step for both";
  session.link_sides(false);
  EXPECT_TRUE(session.ask("strap_L", 0.85));
  EXPECT_EQ(session.now().lines[1].ratio, 0.95);
  session.adopt("B1", {{"chest", 0.9, ""}, {"_L", 1, ""}});
  EXPECT_FALSE(session.has_pairs());
}

TEST(FitSession, WhatWasUndoneIsDoneAgainUntilSomethingElseIs) {
  FitSession session;
  session.adopt("B1", {{"chest", 0.95, ""}});
  session.ask("chest", 0.9);
  EXPECT_FALSE(session.can_redo());
  EXPECT_FALSE(session.redo());
  ASSERT_TRUE(session.undo());
  ASSERT_TRUE(session.can_redo());
  ASSERT_TRUE(session.redo());
  EXPECT_EQ(session.now().lines[0].ratio, 0.9);
  ASSERT_TRUE(session.undo());
  session.ask("chest", 0.8);
  EXPECT_FALSE(session.can_redo());
}

TEST(FitSession, TheLastCustomersStepsAreForgottenAndWhatIsWornStays) {
  FitSession session = both_worn();
  session.ask("chest", 0.9);
  session.settle();
  session.ask("chest", 0.85);
  ASSERT_TRUE(session.undo());
  ASSERT_TRUE(session.can_undo() && session.can_redo());
  session.forget_steps();
  EXPECT_FALSE(session.undo());
  EXPECT_FALSE(session.redo());
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), 0.9);
  EXPECT_TRUE(session.ask("chest", 0.88)) << "the next customer's";
  ASSERT_TRUE(session.undo());
  EXPECT_DOUBLE_EQ(ratio_of(session, "chest"), 0.9);
  EXPECT_FALSE(session.can_undo());
}

}  // namespace
}  // namespace tensegric_fit::inspect
