// Folds of known angles, stretched sheets and turned ones; lines over a sheet.
#include "tffd/skin_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/garment_check.hpp"
#include "tffd/not_scanned.hpp"
#include "tffd/skin_over_line.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
using geometry::FitWarning;

constexpr double kDegree = M_PI / 180;
constexpr double kSide = 0.005;  // m, of the sheet's squares
constexpr int kSquares = 40;

// A square sheet of 20 cm in the plane z = 0, normals up.
geometry::TriangleMesh sheet() {
  geometry::TriangleMesh mesh;
  for (int j = 0; j <= kSquares; ++j)
    for (int i = 0; i <= kSquares; ++i) mesh.vertices.emplace_back(kSide * i, kSide * j, 0);
  for (int j = 0; j < kSquares; ++j)
    for (int i = 0; i < kSquares; ++i) {
      const int a = j * (kSquares + 1) + i, b = a + 1, c = a + kSquares + 1, d = c + 1;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  return mesh;
}

// The sheet with a step: columns from..to of squares stand at an angle, the rest stays level.
std::vector<Vector3d> stepped(const geometry::TriangleMesh& mesh, int from, int to, double angle) {
  std::vector<Vector3d> moved = mesh.vertices;
  for (Vector3d& p : moved) {
    const double within = std::clamp(p.x() - from * kSide, 0.0, (to - from) * kSide);
    p.x() += within * (std::cos(angle) - 1);
    p.z() += within * std::sin(angle);
  }
  return moved;
}

// Down the middle of the sheet, along y.
std::vector<WornLine> line_at(double x, double height = 0) {
  return {{"band", {{x, 0, 0}, {x, 0.2, 0}}, {{x, 0, height}, {x, 0.2, height}}, 0.2, 0.2, 1.0}};
}

std::vector<FitWarning> with_code(const std::vector<FitWarning>& all, const std::string& code) {
  std::vector<FitWarning> found;
  for (const FitWarning& warning : all)
    if (warning.code == code) found.push_back(warning);
  return found;
}

TEST(SkinCheck, StepOfKnownAngles) {
  const geometry::TriangleMesh mesh = sheet();
  const double area = 4 * kSide * 0.2;
  for (const double degrees : {10.0, 44.0, 46.0, 59.0, 61.0, 80.0, 89.0}) {
    const std::vector<Vector3d> moved = stepped(mesh, 10, 14, degrees * kDegree);
    const auto all = check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.05));
    const auto shelves = with_code(all, geometry::warning::kShelf),
               turns = with_code(all, geometry::notice::kSkinTurns);
    EXPECT_EQ(shelves.size(), degrees > 60 ? 1u : 0u) << degrees;
    EXPECT_EQ(turns.size(), degrees > 45 && degrees < 60 ? 1u : 0u) << degrees;
    EXPECT_TRUE(with_code(all, geometry::warning::kTurnedOver).empty()) << degrees;
    for (const FitWarning& found : degrees > 60 ? shelves : turns) {
      EXPECT_NEAR(found.value, degrees * kDegree, 1e-9);
      EXPECT_NEAR(found.area, area, 1e-9);
      EXPECT_NEAR(found.shelf_area, degrees > 60 ? area : 0, 1e-9);
      EXPECT_NEAR((found.at_rest - Vector3d(0.06, 0.1, 0)).norm(), 0, 1e-9);
      EXPECT_EQ(found.line, "band");
      EXPECT_EQ(found.vertices.size(), 5u * (kSquares + 1));
    }
  }
}

TEST(SkinCheck, OfAPlaceWithSeveralAnglesTheSteepestIsNamed) {
  const geometry::TriangleMesh mesh = sheet();
  std::vector<Vector3d> moved = stepped(mesh, 10, 12, 80 * kDegree);
  const std::vector<Vector3d> second = stepped(mesh, 12, 14, 65 * kDegree);
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += second[i] - mesh.vertices[i];
  const auto shelves =
      with_code(check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.05)), geometry::warning::kShelf);
  ASSERT_EQ(shelves.size(), 1u);
  EXPECT_NEAR(shelves[0].value, 80 * kDegree, 1e-9);
}

TEST(SkinCheck, TurnedOverIsNamed) {
  const geometry::TriangleMesh mesh = sheet();
  const std::vector<Vector3d> moved = stepped(mesh, 10, 14, 150 * kDegree);
  const auto all = check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.05));
  const auto over = with_code(all, geometry::warning::kTurnedOver);
  ASSERT_EQ(over.size(), 1u);
  EXPECT_NEAR(over[0].value, 150 * kDegree, 1e-9);
  EXPECT_NEAR(over[0].area, 4 * kSide * 0.2, 1e-9);
  EXPECT_TRUE(over[0].is_warning());
  // Less than a square centimetre of it is no shelf, and said all the same.
  std::vector<Vector3d> little = mesh.vertices;
  const int corner = 20 * (kSquares + 1) + 10;
  little[corner].x() -= 2 * kSide;
  const auto notices = check_skin({mesh.vertices, little, mesh.triangles}, line_at(0.05));
  EXPECT_EQ(with_code(notices, geometry::notice::kSkinTurns).size(), 1u);
  for (const FitWarning& notice : notices) EXPECT_FALSE(notice.is_warning());
}

TEST(SkinCheck, SkinTurnsOverAtARightAngle) {
  const geometry::TriangleMesh mesh = sheet();
  for (const double degrees : {0.0, 80.0, 89.0, 91.0, 180.0})
    EXPECT_EQ(turns_over({mesh.vertices, stepped(mesh, 10, 14, degrees * kDegree), mesh.triangles}),
              degrees > 90)
        << degrees;
  // A needle of the mesh, a tenth of a triangle that counts, is no fold.
  const std::vector<Vector3d> needle{{0, 0, 0}, {0.01, 0, 0}, {0.005, 0.0005, 0}};
  std::vector<Vector3d> over = needle;
  over[2].y() = -0.0005;
  EXPECT_FALSE(turns_over({needle, over, {{0, 1, 2}}}));
}

TEST(SkinCheck, LittleShelvesAddUpAndEachIsNamed) {
  geometry::TriangleMesh mesh = sheet();
  // A row of separate teeth: single vertices lifted steeply, each less than a square centimetre of skin.
  std::vector<Vector3d> moved = mesh.vertices;
  const int row = 20 * (kSquares + 1);
  moved[row + 10].z() += 0.02;
  const auto one = check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.05));
  EXPECT_TRUE(with_code(one, geometry::warning::kShelf).empty());
  moved[row + 20].z() += 0.02;
  const auto two = check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.05));
  EXPECT_EQ(with_code(two, geometry::warning::kShelf).size(), 2u);
}

TEST(SkinCheck, PlaceThatIsFarFromEveryLineHasNone) {
  const geometry::TriangleMesh mesh = sheet();
  const std::vector<Vector3d> moved = stepped(mesh, 0, 4, 70 * kDegree);
  const auto all = check_skin({mesh.vertices, moved, mesh.triangles}, line_at(0.19));
  ASSERT_EQ(with_code(all, geometry::warning::kShelf).size(), 1u);
  EXPECT_EQ(all[0].line, "");
}

TEST(SkinCheck, StretchInOneDirection) {
  const geometry::TriangleMesh mesh = sheet();
  const auto scaled = [&](double along) {
    std::vector<Vector3d> moved = mesh.vertices;
    for (Vector3d& p : moved) p.x() *= along;
    return check_skin({mesh.vertices, moved, mesh.triangles}, {});
  };
  EXPECT_TRUE(scaled(1.59).empty());
  EXPECT_TRUE(scaled(0.51).empty());
  const auto long_one = scaled(1.7), short_one = scaled(0.4);
  ASSERT_EQ(long_one.size(), 1u);
  EXPECT_EQ(long_one[0].code, geometry::notice::kOverStretched);
  EXPECT_NEAR(long_one[0].value, 1.7, 1e-9);
  EXPECT_NEAR(long_one[0].area, 0.04, 1e-9);
  ASSERT_EQ(short_one.size(), 1u);
  EXPECT_EQ(short_one[0].code, geometry::notice::kPressedTogether);
  EXPECT_NEAR(short_one[0].value, 0.4, 1e-9);
  EXPECT_FALSE(short_one[0].is_warning());
}

TEST(SkinCheck, PostureAndForcesTurnNothing) {
  const geometry::TriangleMesh mesh = sheet();
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(1.2, Vector3d(1, 2, 3).normalized());
  std::vector<Vector3d> posed = mesh.vertices;
  for (Vector3d& p : posed) p = turn * p;
  // Both in the posture; and a force without a garment, which may bend a shape as a whole.
  EXPECT_TRUE(check_skin({posed, posed, mesh.triangles}, line_at(0.05)).empty());
  EXPECT_TRUE(check_skin({mesh.vertices, posed, mesh.triangles}, {}).empty());
  // What the garment adds is measured from there.
  std::vector<Vector3d> worn = stepped(mesh, 10, 14, 70 * kDegree);
  for (Vector3d& p : worn) p = turn * p;
  const auto all = check_skin({posed, worn, mesh.triangles}, line_at(0.05));
  ASSERT_FALSE(all.empty());
  EXPECT_NEAR(all[0].value, 70 * kDegree, 1e-9);
}

TEST(SkinCheck, WrongNumberOfPlacesIsRefused) {
  const geometry::TriangleMesh mesh = sheet();
  EXPECT_THROW(check_skin({mesh.vertices, {}, mesh.triangles}, {}), geometry::Refusal);
  EXPECT_THROW(under_constricted({mesh.vertices, {}, mesh.triangles}, {}, {}), geometry::Refusal);
}

TEST(UnderConstriction, SlackWeakAndLifted) {
  const geometry::TriangleMesh mesh = sheet();
  const WornSkin skin{mesh.vertices, mesh.vertices, mesh.triangles};
  const auto found = [&](WornLine line) { return under_constricted(skin, {line}, HoldOptions()); };
  WornLine line = line_at(0.1)[0];
  EXPECT_TRUE(found(line).empty());
  line.tension = 0;
  ASSERT_EQ(found(line).size(), 1u);
  EXPECT_EQ(found(line)[0].lack, geometry::lack::kSlack);
  line.tension = 0.05;
  EXPECT_EQ(found(line)[0].lack, geometry::lack::kWeak);
  EXPECT_EQ(found(line)[0].value, 0.05);
  line.tension = 1;
  line.final = 0.99 * line.neutral;
  EXPECT_EQ(found(line)[0].lack, geometry::lack::kSlack);

  line = line_at(0.1, 0.006)[0];
  ASSERT_EQ(found(line).size(), 1u);
  EXPECT_EQ(found(line)[0].lack, geometry::lack::kLiftsOff);
  EXPECT_DOUBLE_EQ(found(line)[0].value, 1);
  line.at_rest = line.worn;  // it was made to bridge
  EXPECT_TRUE(found(line).empty());
  EXPECT_TRUE(found(line_at(0.1, 0.004)[0]).empty());
}

TEST(GarmentCheck, PlacesAreThoseOfTheScanWhateverThePosture) {
  const geometry::TriangleMesh mesh = sheet();
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(0.1, -0.2, 0.3) * Eigen::AngleAxisd(0.5, Vector3d::UnitZ());
  std::vector<Vector3d> posed = mesh.vertices, worn = stepped(mesh, 10, 14, 70 * kDegree);
  const auto expected = with_code(
      check_garment({mesh.vertices}, {mesh.vertices, worn, mesh.triangles}, line_at(0.05), HoldOptions()),
      geometry::warning::kShelf);
  for (Vector3d& p : posed) p = turn * p;
  for (Vector3d& p : worn) p = turn * p;
  const auto found =
      with_code(check_garment({mesh.vertices}, {posed, worn, mesh.triangles}, line_at(0.05), HoldOptions()),
                geometry::warning::kShelf);
  ASSERT_EQ(expected.size(), 1u);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT((found[0].at_rest - expected[0].at_rest).norm(), 1e-12);
  EXPECT_LT((found[0].worn - turn * expected[0].worn).norm(), 1e-12);
}

TEST(GarmentCheck, NamesSkinThatFoldsAndLinesThatDoNotHold) {
  const geometry::TriangleMesh mesh = sheet();
  WornLine slack = line_at(0.15)[0];
  slack.tension = 0;
  const std::vector<Vector3d> worn = stepped(mesh, 10, 14, 70 * kDegree);
  const auto all =
      check_garment({mesh.vertices}, {mesh.vertices, worn, mesh.triangles}, {slack}, HoldOptions());
  EXPECT_EQ(with_code(all, geometry::warning::kShelf).size(), 1u);
  EXPECT_EQ(with_code(all, geometry::notice::kUnderConstricted).size(), 1u);
}

TEST(SkinOverLine, ALineDeeperInTheSkinThanAtRest) {
  const geometry::TriangleMesh mesh = sheet();
  const auto found = [&](const WornLine& line) {
    return skin_over_lines({mesh.vertices, mesh.vertices, mesh.triangles}, {line});
  };
  WornLine line = line_at(0.1, -0.008)[0];
  line.at_rest = line_at(0.1)[0].at_rest;
  ASSERT_EQ(found(line).size(), 1u);
  EXPECT_EQ(found(line)[0].code, geometry::notice::kSkinOverLine);
  EXPECT_FALSE(found(line)[0].is_warning());
  EXPECT_NEAR(found(line)[0].value, 0.008, 1e-12);
  EXPECT_FALSE(found(line)[0].vertices.empty());
  line.at_rest = line_at(0.1, -0.004)[0].worn;  // chords between nodes of a string lie in the skin
  EXPECT_TRUE(found(line).empty());
  line = line_at(0.1, 0.02)[0];
  EXPECT_TRUE(found(line).empty()) << "above the skin";
}

TEST(NotScanned, ALineMostlyOverSkinThatNobodySaw) {
  const geometry::TriangleMesh mesh = sheet();
  const std::vector<WornLine> lines = line_at(0.1);  // along y
  double low = 1e9, high = -1e9;
  for (const Vector3d& p : lines[0].at_rest) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const auto found = [&](double share) {  // unseen up to there
    std::vector<char> filled;
    for (const Vector3d& p : mesh.vertices) filled.push_back(p.y() < low + share * (high - low) ? 1 : 0);
    return not_scanned({mesh.vertices, mesh.vertices, mesh.triangles}, filled, lines);
  };
  EXPECT_TRUE(found(0).empty());
  EXPECT_TRUE(found(0.4).empty());
  for (const double share : {0.6, 0.8}) {
    const auto notices = found(share);
    ASSERT_EQ(notices.size(), 1u);
    EXPECT_EQ(notices[0].code, geometry::notice::kNotScanned);
    EXPECT_FALSE(notices[0].is_warning());
    EXPECT_EQ(notices[0].line, lines[0].name);
    EXPECT_NEAR(notices[0].value, share, 0.1);  // points of the line are 10 mm apart
    EXPECT_FALSE(notices[0].vertices.empty());
    for (const int v : notices[0].vertices) {
      EXPECT_LT(std::abs(mesh.vertices[v].x() - 0.1), kHeldSkin + kSide);
      EXPECT_LT(mesh.vertices[v].y(), low + share * (high - low) + kHeldSkin + kSide);
    }
  }
  const WornSkin skin{mesh.vertices, mesh.vertices, mesh.triangles};
  EXPECT_TRUE(not_scanned(skin, {}, lines).empty());
  EXPECT_THROW(not_scanned(skin, {1}, lines), geometry::Refusal);
}

TEST(UnderConstriction, SkinUnderTheLine) {
  const geometry::TriangleMesh mesh = sheet();
  WornLine line = line_at(0.1)[0];
  line.tension = 0;
  const auto found = under_constricted({mesh.vertices, mesh.vertices, mesh.triangles}, {line}, HoldOptions());
  const std::vector<int> skin = under_constricted_skin(found);
  EXPECT_TRUE(std::is_sorted(skin.begin(), skin.end()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double off = std::abs(mesh.vertices[v].x() - 0.1);
    const bool is_in = std::binary_search(skin.begin(), skin.end(), static_cast<int>(v));
    EXPECT_TRUE(is_in || off >= kHeldSkin - kSide) << v;
    EXPECT_TRUE(!is_in || off <= kHeldSkin + kSide) << v;
  }
  EXPECT_NEAR(found[0].area, 2 * kHeldSkin * 0.2, 0.2 * 2 * kHeldSkin * 0.2);
  EXPECT_EQ(under_constricted_skin({found[0], found[0]}), skin);  // each vertex once
}

}  // namespace
}  // namespace tensegric_fit::tffd
