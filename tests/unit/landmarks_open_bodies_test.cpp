// Landmarks on the open test bodies, against their truth.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "geometry/ply.hpp"
#include "measured_body.hpp"

namespace tensegric_fit {
namespace {

class OpenBody : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string base = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/../shared/data/open/" + GetParam();
    if (!std::filesystem::exists(base + "_body.ply")) GTEST_SKIP() << "the open bodies are not here";
    mesh = geometry::read_ply_mesh(base + "_body.ply");
    std::ifstream(base + "_truth.json") >> truth;
  }

  geometry::TriangleMesh mesh;
  nlohmann::json truth;
};

bool is_small(const std::string& girth) {
  return girth == "neck" || girth.rfind("upper_arm", 0) == 0;
}

// ISO 20685 asks for 4 mm in heights and small girths and 9 mm in large ones; hips are 6 mm because truth
// takes a vertex of its own coarse mesh for the furthest point of a flat bulge.
TEST_P(OpenBody, MeasuresAgreeWithTruth) {
  const geometry::BodyMeasures measures = test::measured(mesh);
  const bool has_waist = truth["extra"]["waist_method"].get<std::string>().find("ruler") == std::string::npos;
  for (const char* name : {"bust", "underbust", "waist", "hip", "crotch", "neck", "stature"}) {
    const double limit = std::string(name) == "hip" ? 0.006 : 0.004;
    if (std::string(name) == "waist" && !has_waist) continue;
    EXPECT_NEAR(measures.height(name), truth["heights"][name].get<double>(), limit) << name;
  }
  for (const geometry::Measure& girth : measures.girths) {
    if (girth.name == "waist" && !has_waist) continue;
    if (girth.name ==
        "neck") {  // there it was taken in the plane of its base, which is not where it is least
      EXPECT_LT(girth.metres, truth["girths"]["neck"].get<double>() + 0.004);
      EXPECT_GT(girth.metres, truth["girths"]["neck"].get<double>() - 0.030);
      continue;
    }
    EXPECT_NEAR(girth.metres, truth["girths"][girth.name].get<double>(), is_small(girth.name) ? 0.004 : 0.009)
        << girth.name;
  }
  for (const auto& [name, limit] : std::vector<std::pair<std::string, double>>{
           {"bust_point", 0.005}, {"buttock", 0.010}, {"axilla", 0.010}, {"shoulder", 0.010}}) {
    for (const char* side : {"_L", "_R"}) {
      const auto p = truth["landmarks"][name + side].get<std::vector<double>>();
      EXPECT_LT((measures.landmark(name + side) - Eigen::Vector3d(p[0], p[1], p[2])).norm(), limit)
          << name << side;
    }
  }
  for (const char* name : {"crotch", "neck_back", "neck_front", "neck_side_L", "neck_side_R"}) {
    const auto p = truth["landmarks"][name].get<std::vector<double>>();
    EXPECT_LT((measures.landmark(name) - Eigen::Vector3d(p[0], p[1], p[2])).norm(), 0.010) << name;
  }
  // The bodies face -y.
  EXPECT_GT(measures.body_from_scan.linear().row(0).dot(-Eigen::RowVector3d::UnitY()),
            std::cos(3 * 3.14159 / 180));
}

// ISO 20685 asks for 5 mm; every coordinate is moved at random, half a millimetre deviation.
TEST_P(OpenBody, BustPointsStayInNoise) {
  std::mt19937 random(1);
  const auto moved = [&random] { return 0.0005 * (random() / 2147483648.0 - 1) * std::sqrt(3); };
  for (Eigen::Vector3d& p : mesh.vertices) p += Eigen::Vector3d::NullaryExpr(moved);
  const geometry::BodyMeasures measures = test::measured(mesh);
  for (const char* name : {"bust_point_L", "bust_point_R"}) {
    const auto p = truth["landmarks"][name].get<std::vector<double>>();
    EXPECT_LT((measures.landmark(name) - Eigen::Vector3d(p[0], p[1], p[2])).norm(), 0.005) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Landmarks, OpenBody, testing::Values("F0", "F1", "F2"));

}  // namespace
}  // namespace tensegric_fit
