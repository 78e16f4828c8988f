// What the shipped garments do to bodies of the virtual booth (P2 §4): templates, lines and solver together.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fit/chain.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit {
namespace {

using Eigen::Vector3d;

const std::string kLaunch = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/";

/// In the body frame, metres; control nodes.
struct Effect {
  double lift_left, lift_right;  ///< of the tips (bust points or buttock points)
  double spread;                 ///< change of the distance between them
  double width;                  ///< change of the distance between the sides
  double least_area, most_area;  ///< of a control triangle, after / before
  int turned;                    ///< control triangles that face the other way
};

class Worn : public testing::TestWithParam<double> {  // the parameter is the size of hips and bust
 protected:
  static void SetUpTestSuite() { fitted_ = new std::map<std::string, Fitted>; }
  static void TearDownTestSuite() {
    delete fitted_;
    fitted_ = nullptr;
  }

  static Effect wear(const std::string& name, double ratio) {
    auto garment = tensegric::load_garment(kLaunch + "garments/" + name + ".yaml");
    tensegric::set_ratio(garment, "", ratio);
    const Fitted& fitted = fitted_on(garment.regions.at(0), GetParam());
    const auto& control = fitted.fitting.control;
    fit::StageTimes times;
    const auto solution = fit::wear(fitted.body, fitted.fitting, garment, {}, times).solution;
    EXPECT_EQ(tensegric::to_string(solution.status), "converged") << name;

    const bool bust = garment.regions[0] == "bust";
    const std::string tip = bust ? "bust_point" : "buttock_point", side = bust ? "axilla" : "hip_side";
    const auto moved = [&](const std::string& node) -> Vector3d {
      return fitted.body.measures.body_from_scan.linear() *
             (solution.outer[control.node(node)] - control.outer[control.node(node)]);
    };
    const auto apart = [&](const std::string& stem, const std::vector<Vector3d>& nodes) {
      return (nodes[control.node(stem + "_L")] - nodes[control.node(stem + "_R")]).norm();
    };
    Effect effect{moved(tip + "_L").z(),
                  moved(tip + "_R").z(),
                  apart(tip, solution.outer) - apart(tip, control.outer),
                  apart(side, solution.outer) - apart(side, control.outer),
                  1,
                  1,
                  0};
    for (const auto& t : control.triangles) {
      const Vector3d before =
          geometry::area_vector(control.outer[t[0]], control.outer[t[1]], control.outer[t[2]]);
      const Vector3d after =
          geometry::area_vector(solution.outer[t[0]], solution.outer[t[1]], solution.outer[t[2]]);
      effect.least_area = std::min(effect.least_area, after.norm() / before.norm());
      effect.most_area = std::max(effect.most_area, after.norm() / before.norm());
      if (after.dot(before) <= 0) ++effect.turned;
    }
    return effect;
  }

 private:
  struct Fitted {
    fit::Body body;
    fit::Fitting fitting;
  };

  static const Fitted& fitted_on(const std::string& region, double size) {
    const std::string key = region + std::to_string(size);
    const auto found = fitted_->find(key);
    if (found != fitted_->end()) return found->second;
    virtual_body::BodyParameters parameters;
    parameters.bust = parameters.hip = size;
    parameters.asymmetry = size > 1 ? 0.1 : 0;
    fit::StageTimes times;
    const fit::Body body = fit::measure_mesh(virtual_body::make_body(parameters).mesh, {}, times);
    const std::vector<control_mesh::Template> patterns{
        control_mesh::load_template(kLaunch + "templates/" + region + ".yaml")};
    return fitted_->emplace(key, Fitted{body, fit::prepare(body, patterns, {}, times)}).first->second;
  }

  static std::map<std::string, Fitted>* fitted_;
};

std::map<std::string, Worn::Fitted>* Worn::fitted_ = nullptr;

INSTANTIATE_TEST_SUITE_P(SlimAndFull, Worn, testing::Values(1.0, 1.1));

TEST_P(Worn, NoControlTriangleTurnsOver) {
  for (const char* name : {"B1", "B2", "B3", "B4", "cups", "H1", "H2", "H3", "H4"})
    for (double ratio : {0.95, 0.90}) EXPECT_EQ(wear(name, ratio).turned, 0) << name << " at " << ratio;
}

TEST_P(Worn, GatheringGarmentsMoveTheTipsTogether) {
  for (const char* name : {"B4", "H4"}) EXPECT_LT(wear(name, 0.90).spread, -0.005) << name;
}

// The crossed one draws the buttocks apart as well, and lifts least.
TEST_P(Worn, LiftingGarmentsLift) {
  for (const char* name : {"B2", "cups", "H2", "H3"})
    for (double ratio : {0.95, 0.90}) {
      const Effect effect = wear(name, ratio);
      EXPECT_GT(std::min(effect.lift_left, effect.lift_right), 0.0005) << name << " at " << ratio;
    }
}

TEST_P(Worn, HipsAreNarrowedByH1) {
  EXPECT_LT(wear("H1", 0.90).width, -0.010);
}

// P2 §4 reports dents under H2 and H3.
TEST_P(Worn, LiftedButtocksHaveNoDents) {
  for (const char* name : {"H2", "H3"}) {
    const Effect effect = wear(name, 0.95);
    EXPECT_GT(effect.least_area, 0.5) << name;
    EXPECT_LT(effect.most_area, 2) << name;
  }
}

}  // namespace
}  // namespace tensegric_fit
