#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/section.hpp"
#include "true_girth.hpp"
#include "virtual_body/spine.hpp"
#include "virtual_booth/random_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;
using virtual_body::BodyParameters;
using virtual_body::VirtualBody;

TEST(SpineTest, BendingAndStraighteningUndoEachOther) {
  const virtual_body::Spine spine({{0.98, 1.30, 0.0, 0.35}, {1.43, 1.52, 0.04, -0.2}});
  for (double x = -0.15; x < 0.25; x += 0.05)
    for (double z = 0.9; z < 1.7; z += 0.04) {
      const Vector3d p(x, 0.1, z);
      EXPECT_LT((spine.straightened(spine.bent(p)) - p).norm(), 1e-12) << p.transpose();
    }
  // The spine keeps its length, and above the last arc she is turned by the sum of the angles
  double length = 0;
  for (int i = 0; i < 1000; ++i)
    length += (spine.bent({0, 0, 0.98 + 0.00032 * (i + 1)}) - spine.bent({0, 0, 0.98 + 0.00032 * i})).norm();
  EXPECT_NEAR(length, 0.32, 1e-6);  // chords of 0.3 mm
  const Vector3d up = spine.bent_direction({0.05, 0, 1.6}, Vector3d::UnitZ());
  EXPECT_NEAR(std::atan2(up.x(), up.z()), 0.35 - 0.2, 1e-9);
}

TEST(PopulationTest, BodiesSpanWomenAndAreClosed) {
  double least = 2, most = 0, widest_arms = 0, narrowest_arms = 2;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const BodyParameters p = virtual_booth::random_body(seed);
    EXPECT_NO_THROW(virtual_body::check_parameters(p)) << "seed " << seed;
    least = std::min(least, p.stature);
    most = std::max(most, p.stature);
    narrowest_arms = std::min(narrowest_arms, p.arm_angle);
    widest_arms = std::max(widest_arms, p.arm_angle);
  }
  EXPECT_LT(least, 1.53);
  EXPECT_GT(most, 1.77);
  EXPECT_LT(narrowest_arms, 17 * M_PI / 180);
  EXPECT_GT(widest_arms, 75 * M_PI / 180);
  for (const std::uint64_t seed : {9, 11, 57}) {  // soft and round, stooped, arms held out
    const VirtualBody body = virtual_body::make_body(virtual_booth::random_body(seed));
    EXPECT_TRUE(geometry::is_closed(body.mesh)) << "seed " << seed;
    EXPECT_GT(true_girth(body, "bust"), 0.75) << "seed " << seed;
    EXPECT_LT(true_girth(body, "bust"), 1.35) << "seed " << seed;
    EXPECT_GT(true_girth(body, "bust"), true_girth(body, "underbust") + 0.02) << "seed " << seed;
    EXPECT_GT(body.truth.height("bust"), body.truth.height("underbust") - 0.05) << "seed " << seed;
  }
}

TEST(PopulationTest, BreastsWithoutFirmnessHangOverTheirFolds) {
  BodyParameters parameters;
  parameters.bust = 1.3;
  parameters.firmness = -0.7;
  const VirtualBody body = virtual_body::make_body(parameters);
  const Vector3d tip = body.truth.landmark("bust_point_L"), fold = body.truth.landmark("underbust_L");
  EXPECT_LT(tip.z(), fold.z());
  EXPECT_LT(fold.x(), tip.x() - 0.04);  // the fold is on the chest behind
}

TEST(PopulationTest, HeavyThighsTouchBelowThePerineumAndStayTwo) {
  // Half the way between the thighs, 20 mm below the crotch
  const auto half_gap = [](const VirtualBody& body) {
    double least = 1;
    for (const Vector3d& p : body.mesh.vertices)
      if (std::abs(p.z() - (body.truth.height("crotch") - 0.020)) < 0.005)
        least = std::min(least, std::abs(p.y()));
    return least;
  };
  BodyParameters parameters;
  const VirtualBody slim = virtual_body::make_body(parameters);
  EXPECT_GT(half_gap(slim), 0.008);
  parameters.build = 1.4;
  parameters.hip = 1.1;
  parameters.arm_angle = 0.6;
  const VirtualBody heavy = virtual_body::make_body(parameters);
  EXPECT_NEAR(half_gap(heavy), 0.0008, 0.0002);  // flat against each other
  // One closed surface without a handle, so nothing has grown together
  EXPECT_EQ(heavy.mesh.vertices.size(), heavy.mesh.triangles.size() / 2 + 2);
  // The perineum is a bone's breadth of skin: fat does not lower it
  EXPECT_NEAR(heavy.truth.height("crotch"), slim.truth.height("crotch"), 0.008);
}

// Material along x at a place, metres.
double thickness_at(const geometry::TriangleMesh& mesh, double y, double z) {
  std::vector<double> crossings;
  for (const geometry::SectionLoop& loop : geometry::plane_section(mesh, {0, 0, z}, Vector3d::UnitZ()))
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      const Vector3d &a = loop.points[i], &b = loop.points[(i + 1) % loop.points.size()];
      if ((a.y() > y) != (b.y() > y))
        crossings.push_back(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
  std::sort(crossings.begin(), crossings.end());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) sum += crossings[i + 1] - crossings[i];
  return sum;
}

TEST(PopulationTest, OverItsRoofAnArmpitIsSoonAsDeepAsTheArm) {
  BodyParameters slim, heavy;
  heavy.build = 1.4;
  heavy.arm_angle = 0.6;
  for (const BodyParameters& parameters : {slim, heavy}) {
    const VirtualBody body = virtual_body::make_body(parameters);
    const Vector3d axilla = body.truth.landmark("axilla_L");
    const auto joined = [&](double over) {
      return thickness_at(body.mesh, axilla.y(), axilla.z() + over) / (1 + 0.7 * (parameters.build - 1));
    };
    // Scanned bodies of women: nothing at the axilla, 80 to 95 mm 12 mm higher, 100 to 120 from 20 mm on.
    EXPECT_LT(joined(-0.003), 0.020);  // triangles are 6.5 mm wide
    EXPECT_GT(joined(0.014), 0.080);
    EXPECT_GT(joined(0.025), 0.095);
    EXPECT_LT(joined(0.025), 0.140);  // heavy skin adds to it
  }
}

TEST(PopulationTest, CollarbonesDoNotGrowWithWeight) {
  const auto collarbone = [](const VirtualBody& body) {
    return body.truth.landmark("shoulder_L").y() - body.truth.landmark("neck_side_L").y();
  };
  BodyParameters parameters;
  const double slim = collarbone(virtual_body::make_body(parameters));
  parameters.build = 1.4;
  parameters.arm_angle = 0.6;
  EXPECT_NEAR(collarbone(virtual_body::make_body(parameters)), slim,
              0.015);  // what lies on the bone grows a little
}

TEST(PopulationTest, AStoopCarriesTheChestForwardAndDown) {
  BodyParameters parameters;
  const VirtualBody upright = virtual_body::make_body(parameters);
  parameters.stoop = 0.35;
  const VirtualBody stooped = virtual_body::make_body(parameters);
  const Vector3d moved = stooped.truth.landmark("neck_front") - upright.truth.landmark("neck_front");
  EXPECT_GT(moved.x(), 0.08);
  EXPECT_LT(moved.z(), -0.02);
  for (const char* name : {"crotch", "buttock_L"})  // below the waist nothing moves
    EXPECT_LT((stooped.truth.landmark(name) - upright.truth.landmark(name)).norm(), 1e-9) << name;
  EXPECT_NEAR(true_girth(stooped, "neck"), true_girth(upright, "neck"), 0.002);  // its plane turns with it
}

TEST(PopulationTest, BoothsAreDrawnWithinTheirSpans) {
  const VirtualBody body = virtual_body::make_body(virtual_booth::random_body(1));
  bool hair = false, frame = false, fracture = false;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const virtual_booth::ScannerOptions scanner = virtual_booth::random_scanner(seed, body);
    const int sensors = scanner.columns * scanner.sensors_per_column;
    EXPECT_TRUE(sensors >= 8 && sensors <= 12) << "seed " << seed;
    EXPECT_TRUE(scanner.noise >= 0.0005 && scanner.noise <= 0.0015) << "seed " << seed;
    EXPECT_LE(scanner.outliers, 0.005) << "seed " << seed;
    EXPECT_LE(scanner.fracture.shift.norm(), 0.015 + 1e-12) << "seed " << seed;
    hair |= !scanner.dark.empty();
    frame |= scanner.frame;
    fracture |= scanner.fracture.shift.norm() > 0;
  }
  EXPECT_TRUE(hair && frame && fracture);
}

}  // namespace
}  // namespace tensegric_fit
