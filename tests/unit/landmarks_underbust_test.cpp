// Folds that lie up a pocket which no sensor sees into.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "landmarks/fold_arc.hpp"
#include "landmarks/girth_levels.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using landmarks::FoldPlace;

constexpr double kReach = 0.055, kLowest = 1.10;
constexpr double kWide = 120 * 3.14159265358979323846 / 180, kNarrow = kWide * 70 / 120;

// A fold on profiles 5 mm apart from 20 mm outside the bust point to 95 mm inside, lowest 35 mm inside.
std::vector<FoldPlace> arc() {
  std::vector<FoldPlace> way;
  for (int k = -4; k <= 19; ++k) {
    const double medial = 0.005 * k;
    way.push_back({medial, kLowest + 8 * std::pow(medial - 0.035, 2), 100, kWide});
  }
  return way;
}

// Between the two profiles the mouth of a pocket is spanned, lowest in its middle by `depth`.
void span(std::vector<FoldPlace>& way, double from, double to, double depth) {
  for (FoldPlace& place : way) {
    const double along = (place.medial - from) / (to - from);
    if (along <= 0 || along >= 1) continue;
    place.height -= depth * 4 * along * (1 - along);
    place.opening = kNarrow;
  }
}

double lowest_of(const std::vector<FoldPlace>& way) {
  double lowest = 1e9;
  for (const FoldPlace& place : way)
    if (place.medial > -0.001 && place.medial < kReach + 0.001) lowest = std::min(lowest, place.height);
  return lowest;
}

// The places within reach.
std::vector<FoldPlace> reached(std::vector<FoldPlace> way) {
  const auto beyond = [](const FoldPlace& place) {
    return place.medial < -0.001 || place.medial > kReach + 0.001;
  };
  way.erase(std::remove_if(way.begin(), way.end(), beyond), way.end());
  return way;
}

TEST(FoldArc, ItsLowestPointIsNotThatOfASpoiltProfile) {
  // 0.1 mm: folds are taken to curve by 8.8 mostly, this one does by 8
  EXPECT_NEAR(landmarks::lowest_of_arc(reached(arc()), kReach), kLowest, 1e-4);
  for (const double depth : {-0.010, 0.010, 0.020}) {
    std::vector<FoldPlace> way = reached(arc());
    way[3].height -= depth;
    way[7].height -= depth;
    // 1 mm: a place counts the less the further it is off, but not for nothing
    EXPECT_NEAR(landmarks::lowest_of_arc(way, kReach), kLowest, 0.001) << depth;
  }
}

TEST(FoldArc, OfAFoldThatFallsAllTheWayItsEndIsLowest) {
  std::vector<FoldPlace> way;
  for (int k = 0; k <= 11; ++k) way.push_back({0.005 * k, kLowest - 0.5 * 0.005 * k, 100, kWide});
  // 2 mm: leans to the curve of folds
  EXPECT_NEAR(landmarks::lowest_of_arc(way, kReach), way.back().height, 0.002);
  EXPECT_NEAR(landmarks::lowest_of_arc({way.front()}, kReach), kLowest, 1e-9);
}

TEST(FoldArc, AFoldThatWasSeenIsWhereItWasFound) {
  EXPECT_EQ(landmarks::fold_above_pocket(arc(), kLowest, kReach), 0);
  EXPECT_FALSE(landmarks::lies_in_pocket(arc(), kReach));
}

TEST(FoldArc, ItsEndsTellWhatAPocketHides) {
  for (const double depth : {0.006, 0.012, 0.025}) {
    std::vector<FoldPlace> way = arc();
    span(way, 0.0, 0.075, depth);
    const double lowest = lowest_of(way);
    EXPECT_TRUE(landmarks::lies_in_pocket(way, kReach));
    // 1 mm: the arc leans to the curve that folds have mostly, and to what was found in the pocket's ends
    EXPECT_NEAR(lowest + landmarks::fold_above_pocket(way, lowest, kReach), kLowest, 0.001) << depth;
  }
}

TEST(FoldArc, IsNotToldByOneEndAlone) {
  std::vector<FoldPlace> way = arc();
  span(way, 0.0, 0.12, 0.012);
  EXPECT_EQ(landmarks::fold_above_pocket(way, lowest_of(way), kReach), 0);
  EXPECT_TRUE(landmarks::lies_in_pocket(way, kReach));
}

TEST(FoldArc, WhatGoesOnDownwardsBeyondItsEndIsNoFold) {
  std::vector<FoldPlace> way = arc();
  span(way, 0.0, 0.075, 0.012);
  const double lowest = lowest_of(way), raised = landmarks::fold_above_pocket(way, lowest, kReach);
  for (int k = 1; k <= 6; ++k) way.push_back({0.095 + 0.005 * k, kLowest + 0.028 - 0.008 * k, 100, kWide});
  // One such place can be taken for noise; it pulls by less than a millimetre.
  EXPECT_NEAR(landmarks::fold_above_pocket(way, lowest, kReach), raised, 0.001);
}

TEST(FoldArc, NothingFoundTellsNothing) {
  EXPECT_EQ(landmarks::fold_above_pocket({}, kLowest, kReach), 0);
  EXPECT_FALSE(landmarks::lies_in_pocket({}, kReach));
}

TEST(TapeCarriedUp, GoesOnAsTheTrunkDoesBelow) {
  const landmarks::BodyShape body(test::person_mesh());
  const landmarks::Trunk trunk(body);
  const auto trunk_at = [&](double z) { return trunk.outline_at(z); };
  const auto round = [&](double z) { return landmarks::tape_length(trunk_at(z)); };
  // Over the hips the trunk slims evenly.
  const double seen = 1.01, slope = (round(seen) - round(seen - 0.02)) / 0.02;
  ASSERT_LT(slope, -0.5);
  for (const double up : {0.0, 0.010, 0.020}) {
    const std::vector<Eigen::Vector3d> tape = landmarks::tape_carried_up(trunk_at, seen, seen + up);
    ASSERT_GE(tape.size(), 3u);
    for (const Eigen::Vector3d& p : tape) EXPECT_EQ(p.z(), seen + up);
    // Seven tenths of the change go on; its slope by five tapes and by two differ by some tenths.
    EXPECT_NEAR(geometry::length_of(tape, true), round(seen) + 0.7 * slope * up, 0.001 - 0.2 * slope * up);
  }
}

TEST(TapeCarriedUp, IsEmptyWhereThereIsNoTrunk) {
  const auto nothing_at = [](double) { return std::vector<landmarks::Outline>{}; };
  EXPECT_TRUE(landmarks::tape_carried_up(nothing_at, 3, 3.01).empty());
}

}  // namespace
}  // namespace tensegric_fit
