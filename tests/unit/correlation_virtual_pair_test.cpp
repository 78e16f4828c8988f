// A customer of the virtual booth, scanned before and in a garment of known thickness that deforms her in a
// known way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "correlation_customer.hpp"

namespace tensegric_fit::correlation {
namespace {

using Eigen::Isometry3d;

constexpr double kGarment = 0.002;  // m, thickness

// She steps out of the booth and in again.
Isometry3d stance() {
  Isometry3d motion = Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(0.09, Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() << 0.03, -0.02, 0;
  return motion;
}

class VirtualPair : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const virtual_body::VirtualBody body = virtual_body::make_body(customer());
    truth_ = std::make_unique<fit::Body>(fit::take_mesh(body.mesh));
    truth_->measures = body.truth;
    before_ = std::make_unique<fit::Body>(scanned(body.mesh, 1));
    fit::StageTimes times;
    measured_truth_ = std::make_unique<fit::Body>(fit::measure_mesh(body.mesh, {}, times));
  }
  static void TearDownTestSuite() {
    truth_.reset();
    before_.reset();
    measured_truth_.reset();
  }

  // Simulated at 0.95 on the scan, worn at 0.92 by the true body.
  static void expect_known_difference(const std::string& region, const std::string& garment) {
    const Dressed sim(*before_, region, garment, 0.95), real(*measured_truth_, region, garment, 0.92);
    const std::vector<SkinPart> parts = parts_of(simulated(*measured_truth_, real));
    const TriangleMesh skin{real.deformed, truth_->mesh.mesh.triangles};
    const TriangleMesh outside =
        thicker(skin, [&](std::size_t v) { return parts[v] == SkinPart::covered ? kGarment : 0; });
    const fit::Body second = scanned(moved(outside, [](const Vector3d& p) { return stance() * p; }), 2);

    const SimulatedBody body = simulated(*before_, sim);
    const Correlation found = correlate(body, worn(second), {kGarment});
    EXPECT_EQ(found.alignment.status, AlignmentStatus::converged);
    EXPECT_LT(found.still.mean_size, 0.0008);  // m; two reconstructions of 1 mm noise
    EXPECT_GT(found.still.compared, 0.8);

    // The true distance: from the simulated body to the true skin where the true motion puts it.
    const SeenSurface true_skin(skin, {});
    const DistanceMap known = distance_map(body, found.parts, true_skin, Isometry3d::Identity(), 0);
    DistanceMap error = found.map;
    double moves = 0;
    for (std::size_t v = 0; v < error.distance.size(); ++v) {
      error.compared[v] = found.map.compared[v] != 0 && known.compared[v] != 0;
      error.distance[v] = found.map.distance[v] - known.distance[v];
      moves = std::max(moves, std::abs(known.distance[v]));
    }
    EXPECT_GT(moves, 0.003);  // m; there is something to be found
    const Summary miss = summary_of(error, body, found.parts, SkinPart::covered);
    EXPECT_LT(miss.mean_size, 0.001);  // the bound at 1 mm noise
    EXPECT_LT(std::abs(miss.mean), 0.0005);
    EXPECT_GT(miss.compared, 0.8);

    const DistanceMap bare =
        distance_map(body, found.parts, SeenSurface(second.mesh.mesh, second.mesh.filled),
                     found.alignment.patch_from_scan, 0);
    EXPECT_NEAR(summary_of(bare, body, found.parts, SkinPart::covered).mean - found.covered.mean, kGarment,
                0.0004);  // m; shallower folds count less
  }

  static std::unique_ptr<fit::Body> truth_, before_, measured_truth_;
};

std::unique_ptr<fit::Body> VirtualPair::truth_, VirtualPair::before_, VirtualPair::measured_truth_;

TEST_F(VirtualPair, BustGarmentTighterThanSimulated) {
  expect_known_difference("bust", "B1");
}

TEST_F(VirtualPair, HipsGarmentTighterThanSimulated) {
  expect_known_difference("hips", "H1");
}

}  // namespace
}  // namespace tensegric_fit::correlation
