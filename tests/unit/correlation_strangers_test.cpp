// Second scans that are not of the customer as she stood before, or not of her skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "correlation_customer.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/posture.hpp"
#include "geometry/status.hpp"
#include "refusal_of.hpp"

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

// Half of her upper back and the tip of a breast: fillings that are far off.
TEST_F(Strangers, WhatTheFirstScanDidNotSeeIsNotCompared) {
  const geometry::BodyMeasures& measures = before_->measures;
  const TriangleMesh& skin = before_->mesh.mesh;
  const std::vector<Vector3d> normals = geometry::vertex_normals(skin.vertices, skin.triangles);
  std::vector<char> filled = before_->mesh.filled;
  std::vector<double> off(filled.size(), 0.0);  // m
  for (std::size_t v = 0; v < off.size(); ++v) {
    const Vector3d p = measures.body_from_scan * skin.vertices[v];
    const bool at_back = (measures.body_from_scan.linear() * normals[v]).x() < -0.5 && p.y() > 0;
    if (at_back && p.z() > measures.height("bust") && p.z() < measures.height("neck")) off[v] = 0.03;
    if ((skin.vertices[v] - measures.landmark("bust_point_L")).norm() < 0.03) off[v] = 0.01;
    if (off[v] > 0) filled[v] = 1;
  }
  const auto way = [&](std::size_t v) { return off[v]; };
  const TriangleMesh rest = thicker(skin, way);
  const std::vector<Vector3d> deformed = thicker({dressed_->deformed, skin.triangles}, way).vertices;

  const std::vector<SkinPart> parts = parts_of({rest, deformed, dressed_->control, measures});  // unflagged
  fit::StageTimes times;
  const fit::Body second = fit::measure_mesh(truth_->mesh, {}, times);
  const Correlation found =
      correlate({rest, deformed, dressed_->control, measures, filled}, worn(second), {});
  EXPECT_LT(found.still.mean_size, 0.001);  // m; the filling of the back is 30 mm off
  int still = 0, covered = 0, still_yet = 0, compared = 0;
  for (std::size_t v = 0; v < off.size(); ++v) {
    if (off[v] == 0) continue;
    still += static_cast<int>(parts[v] == SkinPart::still);
    covered += static_cast<int>(parts[v] == SkinPart::covered);
    still_yet += static_cast<int>(found.parts[v] == SkinPart::still);
    compared += static_cast<int>(found.map.compared[v] != 0);
  }
  EXPECT_GT(still, 100);
  EXPECT_GT(covered, 20);
  EXPECT_EQ(still_yet, 0);
  EXPECT_EQ(compared, 0);
}

// A head that is cropped at the face, hidden feet: the model guesses her stature, or nobody does.
TEST_F(Strangers, WhatIsUnsureOrNotFoundIsNobodyElses) {
  const auto at = [](std::vector<geometry::Measure>& measures, const std::string& name) {
    return std::find_if(measures.begin(), measures.end(),
                        [&name](const geometry::Measure& m) { return m.name == name; });
  };
  fit::StageTimes times;
  fit::Body second = fit::measure_mesh(truth_->mesh, {}, times);
  const SimulatedBody body = simulated(*before_, *dressed_);
  const auto code = [&] { return refusal_of([&] { correlate(body, worn(second), {}); }); };
  const auto stature = at(second.measures.heights, "stature");
  ASSERT_TRUE(stature != second.measures.heights.end());
  stature->metres += 0.04;
  stature->half_width = 0.001;
  EXPECT_EQ(code(), "other_person");
  stature->half_width = 0.05;
  EXPECT_EQ(code(), "accepted");
  second.measures.heights.erase(stature);
  EXPECT_EQ(code(), "accepted");

  geometry::BodyMeasures measures = before_->measures;
  const auto underbust = at(measures.heights, "underbust");
  ASSERT_TRUE(underbust != measures.heights.end());
  measures.heights.erase(underbust);
  const Likeness likeness =
      correlate({body.rest, body.deformed, body.control, measures, body.filled}, worn(second), {}).likeness;
  EXPECT_FALSE(likeness.chest);
  EXPECT_TRUE(likeness.pelvis);
  EXPECT_TRUE(std::isnan(likeness.stature));
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
  EXPECT_EQ(code_of([&] {
              correlate({body.rest, body.deformed, body.control, body.measures, filled}, same, {});
            }),
            "bad_mesh");
}

}  // namespace
}  // namespace tensegric_fit::correlation
