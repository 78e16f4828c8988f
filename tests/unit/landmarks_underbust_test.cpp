// Folds that lie up a pocket which no sensor sees into.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "landmarks/fold_arc.hpp"
#include "landmarks/fold_walls.hpp"
#include "landmarks/girth_levels.hpp"
#include "landmarks_implicit_body.hpp"

namespace tensegric_fit {
namespace {

using landmarks::FoldPlace;

constexpr double kReach = 0.055, kLowest = 1.10;
constexpr double kWide = 120 * 3.14159265358979323846 / 180, kNarrow = kWide * 70 / 120;

// A fold on profiles 5 mm apart from 20 mm outside the bust point to 95 mm inside, lowest 35 mm inside.
std::vector<FoldPlace> arc(double opening = kWide) {
  std::vector<FoldPlace> way;
  for (int k = -4; k <= 19; ++k) {
    const double medial = 0.005 * k;
    way.push_back({medial, kLowest + 8 * std::pow(medial - 0.035, 2), opening});
  }
  return way;
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
  for (int k = 0; k <= 11; ++k) way.push_back({0.005 * k, kLowest - 0.5 * 0.005 * k, kWide});
  // 2 mm: leans to the curve of folds
  EXPECT_NEAR(landmarks::lowest_of_arc(way, kReach), way.back().height, 0.002);
  EXPECT_NEAR(landmarks::lowest_of_arc({way.front()}, kReach), kLowest, 1e-9);
}

TEST(FoldArc, LiesInAPocketWhereMostOfItIsNarrow) {
  EXPECT_FALSE(landmarks::lies_in_pocket(arc(kWide), kReach));
  EXPECT_TRUE(landmarks::lies_in_pocket(arc(kNarrow), kReach));
  std::vector<FoldPlace> way = arc(kWide);
  for (FoldPlace& place : way)
    if (place.medial > 0.021) place.opening = kNarrow;
  EXPECT_TRUE(landmarks::lies_in_pocket(way, kReach));
  for (FoldPlace& place : way) place.opening = -1;
  EXPECT_FALSE(landmarks::lies_in_pocket(way, kReach));
  EXPECT_FALSE(landmarks::lies_in_pocket({}, kReach));
}

using Line = std::vector<Eigen::Vector3d>;

// From the breast's tip down to a fold at the origin, and down the chest.
Line under_a_breast() {
  Line line;
  for (double out = 0.050; out > 0; out -= 0.0005)
    line.emplace_back(out, 0, -0.5 * out + out * out / 0.150);  // as round as a breast
  for (double down = 0; down < 0.070; down += 0.0005) line.emplace_back(0.05 * down, 0, -down);
  return line;
}

// Every point between two of them on the straight line from one to the other by way of `over`.
Line bridged(Line line, std::size_t from, std::size_t to, const Eigen::Vector3d& over) {
  const std::size_t middle = (from + to) / 2;
  const Eigen::Vector3d first = line[from], last = line[to];
  for (std::size_t i = from; i <= to; ++i) {
    const double t = i < middle ? double(i - from) / (middle - from) : double(i - middle) / (to - middle);
    line[i] = i < middle ? (1 - t) * first + t * over : (1 - t) * over + t * last;
  }
  return line;
}

// In even steps of a millimetre, rounded over 8 mm as a mesh is.
landmarks::Profile profile_of(const Line& line) {
  landmarks::Profile profile{{}, 0.001, Eigen::Vector3d::UnitY()};
  Line even;
  double left = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector3d way = line[i] - line[i - 1];
    for (; left <= way.norm(); left += profile.step) even.push_back(line[i - 1] + left * way.normalized());
    left -= way.norm();
  }
  for (std::size_t i = 4; i + 4 < even.size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = i - 4; k <= i + 4; ++k) sum += even[k] / 9;
    profile.points.push_back(sum);
  }
  return profile;
}

// Heights of the most hollow place and of what breast and chest make of it.
std::pair<double, double> fold_on(const landmarks::Profile& profile) {
  int place = 0;
  for (int i = 0; i < static_cast<int>(profile.points.size()); ++i)
    if (profile.hollowness(i, 8) > profile.hollowness(place, 8)) place = i;
  const double found = profile.points[place].z();
  return {found, found + landmarks::fold_above_place(profile, place)};
}

TEST(FoldWalls, LeaveAFoldThatWasSeen) {
  const auto [found, told] = fold_on(profile_of(under_a_breast()));
  EXPECT_NEAR(found, 0, 0.002);
  EXPECT_NEAR(told, 0, 0.003);
}

TEST(FoldWalls, TellThatASpannedFoldIsHigherAndAPitsLower) {
  const Line line = under_a_breast();
  const std::size_t fold = 100;
  for (const std::size_t reach : {24, 36}) {  // half millimetres
    const Eigen::Vector3d between = (line[fold - reach] + line[fold + reach]) / 2;
    const auto [spanned, higher] = fold_on(profile_of(bridged(line, fold - reach, fold + reach, between)));
    EXPECT_LT(spanned, -0.003) << reach;
    EXPECT_GT(higher, spanned + 0.001) << reach;
    EXPECT_LT(std::abs(higher), std::abs(spanned)) << reach;
    const Eigen::Vector3d pit(0.010, 0, 0.008);
    const auto [dug, lower] = fold_on(profile_of(bridged(line, fold - reach - 10, fold + reach / 2, pit)));
    EXPECT_GT(dug, 0.003) << reach;
    EXPECT_LT(lower, dug - 0.001) << reach;
    EXPECT_LT(std::abs(lower), std::abs(dug)) << reach;
  }
}

TEST(FoldWalls, TellNothingWithoutSkin) {
  landmarks::Profile profile = profile_of(under_a_breast());
  EXPECT_EQ(landmarks::fold_above_place(profile, 5), 0);
  EXPECT_EQ(landmarks::fold_above_place(profile, static_cast<int>(profile.points.size()) - 5), 0);
  for (Eigen::Vector3d& p : profile.points) p.x() = 0;  // lines that never meet
  for (std::size_t i = 0; i < profile.points.size(); ++i) profile.points[i].z() = -0.001 * i;
  EXPECT_EQ(landmarks::fold_above_place(profile, 60), 0);
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
