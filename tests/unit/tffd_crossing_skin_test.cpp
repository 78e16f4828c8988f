// A ridge that rises from one sheet through another that hangs over it.
#include "tffd/crossing_skin.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/triangle_mesh.hpp"
#include "tffd/garment_check.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 0.005;  // m, of the sheets' squares
constexpr int kSquares = 40;
constexpr double kGap = 0.0045;  // m, between the sheets
constexpr double kHeight = 0.012;
constexpr double kSlope = 0.8;              // of the ridge
const Vector3d kBeside(0.0025, 0.0017, 0);  // the upper sheet's corners lie over no edge of the lower one

// Both 20 cm square; the lower one's normals up, the upper one's down, as of skin that faces skin.
struct Sheets {
  std::vector<Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

Sheets sheets() {
  Sheets both;
  for (const bool upper : {false, true}) {
    const int first = static_cast<int>(both.vertices.size());
    for (int j = 0; j <= kSquares; ++j)
      for (int i = 0; i <= kSquares; ++i) {
        both.vertices.emplace_back(kSide * i, kSide * j, upper ? kGap : 0);
        if (upper) both.vertices.back() += kBeside;
      }
    for (int j = 0; j < kSquares; ++j)
      for (int i = 0; i < kSquares; ++i) {
        const int a = first + j * (kSquares + 1) + i, b = a + 1, c = a + kSquares + 1, d = c + 1;
        both.triangles.emplace_back(a, upper ? d : b, upper ? b : d);
        both.triangles.emplace_back(a, upper ? c : d, upper ? d : c);
      }
  }
  return both;
}

// The lower sheet with a ridge of that height along y in its middle.
std::vector<Vector3d> ridged(const Sheets& both, double height) {
  std::vector<Vector3d> worn = both.vertices;
  for (std::size_t v = 0; v < worn.size() / 2; ++v)
    worn[v].z() += std::max(0.0, height - kSlope * std::abs(worn[v].x() - kSide * kSquares / 2));
  return worn;
}

const std::vector<WornLine> kLine{
    {"band", {{0.11, 0, 0}, {0.11, 0.2, 0}}, {{0.11, 0, 0}, {0.11, 0.2, 0}}, 0.2, 0.2, 1}};

TEST(CrossingSkin, IsNamedWhereARidgeGoesThroughASheet) {
  const Sheets both = sheets();
  const auto found = check_crossings({both.vertices, ridged(both, kHeight), both.triangles}, kLine);
  ASSERT_EQ(found.size(), 2u);  // both slopes
  for (const geometry::FitWarning& crossing : found) {
    EXPECT_EQ(crossing.code, "skin_crosses");
    EXPECT_TRUE(crossing.is_warning());
    EXPECT_EQ(crossing.line, "band");
    // Of the ridge's height above the sheet, what its row of triangles that go through it has.
    EXPECT_GE(crossing.value, kLeastDepth);
    EXPECT_LT(crossing.value, kHeight - kGap);
    EXPECT_NEAR(std::abs(crossing.worn.x() - 0.1), (kHeight - kGap) / kSlope, kSide);
    EXPECT_NEAR(crossing.worn.y(), 0.1, kSide);
    EXPECT_GT(crossing.area, 0.2 * kSide);      // a row of squares of one sheet
    EXPECT_LT(crossing.area, 6 * 0.2 * kSide);  // three rows of both
  }
  EXPECT_LT((found[0].worn.x() - 0.1) * (found[1].worn.x() - 0.1), 0);
}

TEST(CrossingSkin, IsNotNamedWhereItIsShallowOrWasThereOrStays) {
  const Sheets both = sheets();
  const auto count = [&](const std::vector<Vector3d>& rest, const std::vector<Vector3d>& worn) {
    return check_crossings({rest, worn, both.triangles}, kLine).size();
  };
  EXPECT_EQ(count(both.vertices, both.vertices), 0u);
  EXPECT_EQ(count(both.vertices, ridged(both, 0.9 * kGap)), 0u);              // below the other sheet
  EXPECT_EQ(count(both.vertices, ridged(both, kGap + kLeastDepth / 2)), 0u);  // half a millimetre through it
  EXPECT_EQ(count(ridged(both, kHeight), ridged(both, kHeight)), 0u);         // as at rest
  EXPECT_EQ(count(ridged(both, kHeight), ridged(both, 0.0125)), 0u);          // deeper than at rest
  // A trace at rest does not hide what the garment does.
  EXPECT_EQ(count(ridged(both, kGap + kLeastDepth / 2), ridged(both, kHeight)), 2u);
  // Lines are not needed.
  EXPECT_EQ(check_crossings({both.vertices, ridged(both, kHeight), both.triangles}, {}).size(), 2u);
}

TEST(CrossingSkin, TrianglesOfOneRoundedSkinThatSlideOverEachOtherAreNotNamed) {
  Sheets skin = sheets();
  const std::size_t count = skin.vertices.size() / 2;  // the lower sheet alone, on a cylinder
  skin.vertices.resize(count);
  skin.triangles.resize(skin.triangles.size() / 2);
  constexpr double kRadius = 0.040;
  const auto bent = [](const Vector3d& p) {
    return Vector3d(kRadius * std::sin(p.x() / kRadius), p.y(), kRadius * std::cos(p.x() / kRadius));
  };
  const auto on_cylinder = [&](std::vector<Vector3d> flat) {
    for (Vector3d& p : flat) p = bent(p - Vector3d(kSide * kSquares / 2, 0, 0));
    return flat;
  };
  std::vector<Vector3d> slid = skin.vertices;
  slid[count / 2].x() += 2.3 * kSide;  // over the next one but one
  slid[count / 2].y() += 0.3 * kSide;
  EXPECT_TRUE(check_crossings({on_cylinder(skin.vertices), on_cylinder(slid), skin.triangles}, {}).empty());
}

TEST(CrossingSkin, StandsAmongAGarmentsWarnings) {
  const Sheets both = sheets();
  const std::vector<Vector3d> worn = ridged(both, kHeight);
  int crossings = 0;
  for (const geometry::FitWarning& warning :
       check_garment({both.vertices}, {both.vertices, worn, both.triangles}, kLine, HoldOptions()))
    crossings += warning.code == geometry::warning::kSkinCrosses;
  EXPECT_EQ(crossings, 2);
}

}  // namespace
}  // namespace tensegric_fit::tffd
