#include "inspect/pointing.hpp"

#include <gtest/gtest.h>

namespace tensegric_fit::inspect {
namespace {

// Two squares that face up, one above the other.
const std::vector<Eigen::Vector3d> kVertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<Eigen::Vector3i> kTriangles{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};

TEST(FirstHit, IsTheNearestSkinThatFacesTheRay) {
  const auto hit = first_hit(kVertices, kTriangles, {0.75, 0.25, 5}, {0, 0, -2});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 2);
  EXPECT_NEAR((hit->position - Eigen::Vector3d(0.75, 0.25, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(hit->barycentric.sum(), 1, 1e-12);
  EXPECT_NEAR(value_at(*hit, kTriangles, {0, 0, 0, 0, 0, 1, 1, 0}), 0.75, 1e-12);  // values are x there
}

TEST(FirstHit, IsNothingBesideBehindOrFromInside) {
  EXPECT_FALSE(first_hit(kVertices, kTriangles, {2, 0.5, 5}, {0, 0, -1}));
  EXPECT_FALSE(first_hit(kVertices, kTriangles, {0.5, 0.25, 5}, {0, 0, 1}));
  EXPECT_FALSE(first_hit(kVertices, kTriangles, {0.5, 0.25, -5}, {0, 0, 1}));
  EXPECT_FALSE(first_hit(kVertices, kTriangles, {0.5, 0.25, 5}, {0, 0, 0}));
}

TEST(Spoken, NamesSidesInWords) {
  EXPECT_EQ(spoken("bust_point_L"), "left bust point");
  EXPECT_EQ(spoken("gluteal_fold_R"), "right gluteal fold");
  EXPECT_EQ(spoken("crotch"), "crotch");
}

}  // namespace
}  // namespace tensegric_fit::inspect
