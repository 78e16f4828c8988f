/// Which images of cameras that send all the time make one scan.
#include <gtest/gtest.h>

#include "depth_cameras/one_moment.hpp"

namespace tensegric_fit::depth_cameras {
namespace {

using Stamps = std::vector<std::deque<std::uint64_t>>;
using Chosen = std::vector<int>;

TEST(OneMomentTest, TakesTheEarliestWhereAllAreThere) {
  EXPECT_EQ(of_one_moment({{100, 200}, {101, 201}}, 10), Chosen({0, 0}));
}

TEST(OneMomentTest, WaitsForACameraThatMissedThisMoment) {
  // It was asked between the two cameras' images: the first's next one is of the second's next moment.
  EXPECT_EQ(of_one_moment({{300}, {101, 301}}, 10), Chosen({0, 1}));
}

TEST(OneMomentTest, ASpreadOfSlopIsOneMomentAndMoreIsNot) {
  EXPECT_EQ(of_one_moment({{100}, {110}}, 10), Chosen({0, 0}));
  EXPECT_EQ(of_one_moment({{100}, {111}}, 10), Chosen({0, kNone}));
  EXPECT_EQ(of_one_moment({{100}, {100}}, 0), Chosen({0, 0}));
}

TEST(OneMomentTest, WithoutAllTakesAsManyAsItCan) {
  EXPECT_EQ(of_one_moment({{100, 200}, {205}, {}, {196}}, 10), Chosen({1, 0, kNone, 0}));
}

TEST(OneMomentTest, NoneWhereThereAreNone) {
  EXPECT_EQ(of_one_moment(Stamps(2), 10), Chosen({kNone, kNone}));
}

}  // namespace
}  // namespace tensegric_fit::depth_cameras
