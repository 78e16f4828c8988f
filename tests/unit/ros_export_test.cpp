/// The export of a fit, without a master.
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/export_fit.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;

class ExportFitTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    const ScanTag tag{std_msgs::Header(), "1.000000000-00000001"};
    const geometry::TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    geometry::ControlMesh control;
    control.outer = mesh.vertices;
    control.inner = {{0, 0, -0.1}, {1, 0, -0.1}, {0, 1, -0.1}};
    control.triangles = mesh.triangles;
    control.outer_fixed = control.inner_fixed = {1, 1, 0};
    control.names = {"", "", ""};
    control.regions = {{"bust", {0}}};
    geometry::BodyMeasures measures;
    measures.landmarks = {{"navel", {0.1, 0.2, 0.3}, 0.9, ""}};
    measures.girths = {{"waist", 0.7, 1, ""}};

    const auto fit = boost::make_shared<FitState>();
    fit->garment = "B1\xff";  // no UTF-8: anyone may publish a garment
    fit->outer = {0, 0, 0, 1, 0, 0, 0, 1, 0.25};
    const auto deformed = boost::make_shared<DeformedMesh>();
    deformed->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0.25};
    deformed->distortion = {1, 1, 0.8F};
    scan_ = {boost::make_shared<TriangleMesh>(to_message(tag, mesh, {})),
             boost::make_shared<Landmarks>(to_message(tag, measures)),
             boost::make_shared<ControlMesh>(to_message(tag, control)), fit, deformed};
  }
  void TearDown() override { fs::remove_all(root_); }

  std::string refused(const std::string& directory) const {
    try {
      export_fit(scan_, directory);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  }

  const fs::path root_ = fs::temp_directory_path() / "tensegric_fit_export_test";
  FittedScan scan_;
};

TEST_F(ExportFitTest, WritesMeshesMeasuresAndParameters) {
  const fs::path folder = root_ / "one";
  EXPECT_EQ(export_fit(scan_, folder.string() + "/").size(), 5u);  // a slash at the end does not matter
  const geometry::TriangleMesh deformed = geometry::read_ply_mesh(folder / "deformed.ply");
  EXPECT_EQ(deformed.triangles, geometry::read_ply_mesh(folder / "body.ply").triangles);
  EXPECT_EQ(deformed.vertices.at(2), Eigen::Vector3d(0, 1, 0.25));
  EXPECT_EQ(geometry::read_ply_mesh(folder / "control_deformed.ply").vertices.at(2),
            Eigen::Vector3d(0, 1, 0.25));
  const nlohmann::json report = nlohmann::json::parse(std::ifstream(folder / "report.json"));
  EXPECT_EQ(report["scan"]["scan_id"], "1.000000000-00000001");
  EXPECT_EQ(report["garment"], "B1\uFFFD");
  EXPECT_EQ(report["girths"]["waist"], 0.7);
  EXPECT_EQ(report["landmarks"]["navel"]["position"][2], 0.3);
}

TEST_F(ExportFitTest, OverwritesNothingAndLeavesNothingHalfDone) {
  const fs::path folder = root_ / "one";
  fs::create_directories(folder);
  std::ofstream(folder / "precious") << "mine";
  EXPECT_EQ(refused(folder), "bad_option");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
  EXPECT_EQ(refused("relative/path"), "bad_option");
  EXPECT_EQ(refused(""), "bad_option");

  EXPECT_EQ(refused(root_ / std::string(300, 'x')), "broken_file");  // a longer name than folders have

  std::ofstream(root_ / "file") << "no folder";
  EXPECT_EQ(refused(root_ / "file" / "below"), "broken_file");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_), {}),
            2);  // "one" and "file": no temporary folder stays
}

}  // namespace
}  // namespace tensegric_fit::node
