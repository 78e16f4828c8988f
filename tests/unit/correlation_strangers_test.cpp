// Second scans that are not of the customer as she stood before, or not of her skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "correlation_customer.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/posture.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::correlation {
namespace {

class Strangers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    truth_ = std::make_unique<virtual_body::VirtualBody>(virtual_body::make_body(customer()));
    before_ = std::make_unique<fit::Body>(scanned(truth_->mesh, 1));
    dressed_ = std::make_unique<Dressed>(*before_, "bust", "B1", 0.95);
  }
  static void TearDownTestSuite() {
    truth_.reset();
    before_.reset();
    dressed_.reset();
  }

  // The worn body is what a scan without noise would show.
  static Correlation correlated(const TriangleMesh& body) {
    fit::StageTimes times;
    const fit::Body second = fit::measure_mesh(body, {}, times);
    return correlate(simulated(*before_, *dressed_), worn(second), {});
  }
  static void expect_refused(const TriangleMesh& body, const std::string& code) {
    try {
      correlated(body);
      ADD_FAILURE() << "not refused";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), code) << refusal.what();
    }
  }

  static std::unique_ptr<virtual_body::VirtualBody> truth_;
  static std::unique_ptr<fit::Body> before_;
  static std::unique_ptr<Dressed> dressed_;
};

std::unique_ptr<virtual_body::VirtualBody> Strangers::truth_;
std::unique_ptr<fit::Body> Strangers::before_;
std::unique_ptr<Dressed> Strangers::dressed_;

// Otherwise a refusal would say nothing.
TEST_F(Strangers, SheHerselfIsNot) {
  const Correlation found = correlated(truth_->mesh);
  EXPECT_LT(found.still.mean_size, 0.0006);  // m; one reconstruction of 1 mm noise
}

// Black cloth, for instance, that depth sensors do not see.
TEST_F(Strangers, WhereTheGarmentsSkinWasNotSeenNothingIsSaid) {
  fit::StageTimes times;
  fit::Body second = fit::measure_mesh(truth_->mesh, {}, times);
  second.mesh.filled.assign(second.mesh.mesh.vertices.size(), 0);
  const SimulatedBody body = simulated(*before_, *dressed_);
  std::vector<Eigen::Vector3d> covered;
  const std::vector<SkinPart> parts = parts_of(body);
  for (std::size_t v = 0; v < parts.size(); ++v)
    if (parts[v] == SkinPart::covered) covered.push_back(body.deformed[v]);
  const geometry::PointTree tree(covered);
  for (std::size_t v = 0; v < second.mesh.filled.size(); ++v) {
    const Eigen::Vector3d& p = second.mesh.mesh.vertices[v];
    second.mesh.filled[v] = static_cast<char>((covered[tree.nearest(p)] - p).norm() < 0.03);
  }
  try {
    correlate(body, worn(second), {});
    ADD_FAILURE() << "not refused";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), geometry::refusal::kTooFewData) << refusal.what();
  }
}

TEST_F(Strangers, SomebodyElseIsRefused) {
  virtual_body::BodyParameters other = customer();
  other.build = 1.2;
  other.hip = 1.08;
  expect_refused(virtual_body::make_body(other).mesh, "other_person");
}

TEST_F(Strangers, ATallerTwinIsRefused) {
  virtual_body::BodyParameters other = customer();
  other.stature = 1.70;
  expect_refused(virtual_body::make_body(other).mesh, "other_person");
}

TEST_F(Strangers, OtherPosesAreRefused) {
  virtual_body::BodyParameters stooped = customer();
  stooped.stoop = 0.25;
  expect_refused(virtual_body::make_body(stooped).mesh, "other_pose");

  virtual_body::BodyParameters raised = customer();
  raised.arm_angle = 1.0;
  expect_refused(virtual_body::make_body(raised).mesh, "other_pose");

  const geometry::BoneFrames twist(truth_->truth, {0.2, 0});
  expect_refused(moved(truth_->mesh, [&](const Vector3d& p) { return twist.moved(p); }), "other_pose");
}

TEST_F(Strangers, ACoatIsRefused) {
  const double low = 0.8 * truth_->truth.height("crotch"), high = truth_->truth.height("neck");
  const TriangleMesh& body = truth_->mesh;
  expect_refused(thicker(body,
                         [&](std::size_t v) {
                           const double z = (truth_->truth.body_from_scan * body.vertices[v]).z();
                           return 0.018 * std::clamp(std::min(z - low, high - z) / 0.04, 0.0, 1.0);
                         }),
                 "coat_on");
}

TEST_F(Strangers, BadInputIsRefusedByName) {
  const SimulatedBody body = simulated(*before_, *dressed_);
  const auto code_of = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  };
  const WornBody same = worn(*before_);
  for (const double thickness : {-0.001, 0.031, std::nan("")})
    EXPECT_EQ(code_of([&] { correlate(body, same, {thickness}); }), "bad_option") << thickness;
  std::vector<Vector3d> fewer = dressed_->deformed;
  fewer.pop_back();
  EXPECT_EQ(code_of([&] {
              correlate({body.rest, fewer, body.control, body.measures}, same, {});
            }),
            "bad_mesh");
  fewer.push_back({0, std::nan(""), 0});
  EXPECT_EQ(code_of([&] {
              correlate({body.rest, fewer, body.control, body.measures}, same, {});
            }),
            "non_finite");
  const std::vector<char> filled(3, 0);
  EXPECT_EQ(code_of([&] { correlate(body, {same.mesh, filled, same.measures}, {}); }), "bad_mesh");
}

}  // namespace
}  // namespace tensegric_fit::correlation
