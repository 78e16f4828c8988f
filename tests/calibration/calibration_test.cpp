// Parameters that made a displacement are found again from it; what cannot be calibrated is refused by name.
#include "calibration/calibration.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "calibration/cases_file.hpp"
#include "calibration/newtons_file.hpp"
#include "fit/tissue_file.hpp"
#include "geometry/decimate.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "virtual_body/virtual_body.hpp"

namespace tensegric_fit::calibration {
namespace {

const std::vector<control_mesh::Template>& patterns() {
  static const std::vector<control_mesh::Template> bust = {
      control_mesh::load_template(TENSEGRIC_FIT_SOURCE_DIR "/launch/templates/bust.yaml")};
  return bust;
}

const std::vector<fit::Body>& women() {
  static const std::vector<fit::Body> measured = [] {
    std::vector<fit::Body> made;
    for (double bust : {0.9, 1.0, 1.15}) {
      virtual_body::BodyParameters parameters;
      parameters.bust = bust;
      fit::StageTimes times;
      made.push_back(fit::measure_mesh(
          geometry::with_triangles(virtual_body::make_body(parameters).mesh, 20000), {}, times));
    }
    return made;
  }();
  return measured;
}

tensegric::Garment b1(double ratio) {
  tensegric::Garment garment = tensegric::take_garment("B1", TENSEGRIC_FIT_SOURCE_DIR "/launch/garments");
  tensegric::set_ratio(garment, "", ratio);
  return garment;
}

fit::Fitting fitting_of(const fit::Body& woman, const fit::Settings& settings) {
  fit::StageTimes times;
  return fit::prepare(woman, patterns(), settings, times);
}

std::vector<Eigen::Vector3d> skin_in(const fit::Body& woman, const tensegric::Garment& garment,
                                     const fit::Settings& settings) {
  fit::StageTimes times;
  return fit::wear(woman, fitting_of(woman, settings), garment, settings, times).deformed;
}

// Three women in B1 at 0.95, moved by the model itself.
std::vector<CalibrationBody> moved_by(const fit::Settings& truth) {
  std::vector<CalibrationBody> bodies;
  for (const fit::Body& woman : women()) {
    const std::vector<Eigen::Vector3d> deformed = skin_in(woman, b1(0.95), truth);
    ReferenceField moved;
    for (std::size_t v = 0; v < deformed.size(); ++v) {
      const Eigen::Vector3d way = deformed[v] - woman.mesh.mesh.vertices[v];
      if (way.norm() < 1e-6) continue;
      moved.vertices.push_back(static_cast<int>(v));
      moved.displacements.push_back(way);
    }
    bodies.push_back(
        {"woman " + std::to_string(bodies.size()), woman, {displaced_case("B1", b1(0.95), moved, {})}});
  }
  return bodies;
}

// The same, scanned again in a B1 that shortens more than it says; elsewhere in the booth.
std::vector<CalibrationBody> worn_pairs(double ratio_worn, double ratio_said, const fit::Settings& truth) {
  const Eigen::Isometry3d place(Eigen::Translation3d(0.05, -0.03, 0) *
                                Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  std::vector<CalibrationBody> bodies;
  for (const fit::Body& woman : women()) {
    geometry::TriangleMesh worn = woman.mesh.mesh;
    worn.vertices = skin_in(woman, b1(ratio_worn), truth);
    for (Eigen::Vector3d& v : worn.vertices) v = place * v;
    fit::StageTimes times;
    WornReference reference(woman, fitting_of(woman, {}).control, fit::measure_mesh(worn, {}, times), 0);
    bodies.push_back({"woman " + std::to_string(bodies.size()),
                      woman,
                      {worn_case("B1", b1(ratio_said), std::move(reference), woman)}});
  }
  return bodies;
}

std::string refusal_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const geometry::Refusal& refusal) {
    return refusal.code();
  }
  return "none";
}

Calibration calibrated(const std::vector<CalibrationBody>& bodies, const std::vector<std::string>& fitted) {
  return calibrate(bodies, patterns(), {}, {fitted, 20}, [](const std::string&) {});
}

TEST(Calibration, FindsTheParametersThatMadeTheDisplacement) {
  fit::Settings truth;
  truth.model.strut_stiffness *= 2;
  truth.control_mesh.thickness = 0.85;
  const Calibration found = calibrated(moved_by(truth), {"strut_stiffness", "thickness"});
  // The differences' step is 2 %, so that the last step may be off by some per cent of itself.
  EXPECT_NEAR(found.adjusted.settings.model.strut_stiffness / truth.model.strut_stiffness, 1, 0.05);
  EXPECT_NEAR(found.adjusted.settings.control_mesh.thickness / truth.control_mesh.thickness, 1, 0.02);
  for (const CalibrationError& e : found.errors) {
    EXPECT_LT(e.in_sample, 0.05 * e.before);
    EXPECT_LT(e.out_of_sample, 0.1 * e.before);
  }
}

// A scan says where the skin is, not which point of it went where; so the pull is found, and less exactly.
TEST(Calibration, FindsForceAndThicknessFromWornScans) {
  fit::Settings truth;
  truth.control_mesh.thickness = 0.85;
  const Calibration found = calibrated(worn_pairs(1 - 1.4 * 0.05, 0.95, truth), {"pull", "thickness"});
  EXPECT_NEAR(found.adjusted.pull, 1.4, 0.05);
  EXPECT_NEAR(found.adjusted.settings.control_mesh.thickness, 0.85, 0.05);
  for (const CalibrationError& e : found.errors) {
    EXPECT_GT(e.not_moving, 1e-3);
    EXPECT_LT(e.in_sample, 0.1 * e.before);
    EXPECT_LT(e.out_of_sample, 0.15 * e.before);
  }
}

TEST(Calibration, RefusesByName) {
  const std::vector<CalibrationBody> bodies = moved_by({});
  EXPECT_EQ(refusal_of([&] { calibrated({bodies[0], bodies[1]}, {"skin"}); }), "too_few_data");
  std::vector<CalibrationBody> one_twice = {bodies[0], bodies[1], bodies[0]};
  one_twice[2].fineness = Fineness{480, 1};
  EXPECT_EQ(refusal_of([&] { calibrated(one_twice, {"skin"}); }), "too_few_data");
  EXPECT_EQ(refusal_of([&] { calibrated(bodies, {"colour"}); }), "bad_option");
  std::vector<CalibrationBody> still = bodies;
  ReferenceField nowhere = still[1].cases[0].reference;
  for (Eigen::Vector3d& way : nowhere.displacements) way.setZero();
  still[1].cases[0] = displaced_case("B1", b1(0.95), nowhere, {});
  EXPECT_EQ(refusal_of([&] { calibrated(still, {"skin"}); }), "too_few_data");
  fit::Settings leather;
  leather.model.skin = 1.5;  // beyond what a skin may be
  EXPECT_EQ(refusal_of([&] { calibrated(moved_by(leather), {"skin"}); }), "at_bound");
}

TEST(Calibration, ADensityThatDidNotSettleIsNotTaken) {
  const auto leaving_out = [](double error) {
    Calibration found;
    found.errors.push_back({"A", 0.004, 0.002, 0.001, 0.001});
    found.errors.push_back({"B", 0.004, 0.002, 0.001, error});
    return found;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(least_left_out({leaving_out(0.002), leaving_out(none)}), 0u);
  EXPECT_EQ(least_left_out({leaving_out(none), leaving_out(0.002)}), 1u);
  EXPECT_EQ(least_left_out({leaving_out(0.003), leaving_out(0.002)}), 1u);
  EXPECT_EQ(refusal_of([&] { least_left_out({leaving_out(none), leaving_out(none)}); }), "not_settled");
}

// A folder for a file of cases and what it names.
class CasesFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Cases read(const std::string& text, bool worn) const {
    std::ofstream file(path("cases.yaml"));
    file << text;
    file.close();
    return read_cases(path("cases.yaml"), {}, worn);
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("cases_" + std::to_string(getpid()));
};

TEST_F(CasesFile, ABodyThatIsThereTwiceIsRefused) {
  const std::string body = "{name: A, mesh: nowhere.ply}";
  EXPECT_EQ(refusal_of([&] { read("bodies: [" + body + "]", false); }), "broken_file");
  EXPECT_EQ(refusal_of([&] { read("bodies: [" + body + ", " + body + "]", false); }), "bad_option");
}

TEST_F(CasesFile, WhatIsFittedToWornScansAndHowFineIsNotInIt) {
  for (const char* key : {"fit: [skin]\n", "meshes: [{control_triangles: 120, layers: 1}]\n"}) {
    const std::string text = std::string(key) + "bodies: []\n";
    EXPECT_EQ(refusal_of([&] { read(text, false); }), "none") << key;
    EXPECT_EQ(refusal_of([&] { read(text, true); }), "bad_option") << key;
  }
}

TEST_F(CasesFile, ATensionIsFiniteAndAbove0) {
  geometry::write_ply_mesh(path("body.ply"), women()[0].mesh.mesh);
  const auto code = [&](const std::string& tension) {
    return refusal_of([&] {
      read(
          "bodies: [{name: A, mesh: body.ply, garment: B1, references: [{ratio: 0.95, file: nowhere.csv, "
          "tension: [" +
              tension + "]}]}]",
          false);
    });
  };
  for (const char* bad : {"0", ".inf"}) EXPECT_EQ(code(bad), "bad_option") << bad;
  EXPECT_EQ(code("8"), "broken_file");  // goes on to the reference, which is not there
}

// Inches with y up, and millimetres, as programs of scanners write them.
TEST_F(CasesFile, WornMeshesAndScansAreReadInAnyUnitAndAxes) {
  const fit::Body& woman = women()[1];
  geometry::TriangleMesh inches = woman.mesh.mesh;
  inches.vertices = skin_in(woman, b1(0.93), {});
  geometry::TriangleMesh millimetres = inches;
  for (Eigen::Vector3d& p : inches.vertices) p = Eigen::Vector3d(p.x(), p.z(), -p.y()) / 0.0254;
  for (Eigen::Vector3d& p : millimetres.vertices) p *= 1e3;
  geometry::write_ply_mesh(path("bare.ply"), woman.mesh.mesh);
  geometry::write_ply_mesh(path("inches.ply"), inches);
  geometry::write_ply_mesh(path("millimetres.ply"), millimetres);
  const Cases cases = read(
      "bodies: [{name: A, mesh: bare.ply, garment: B1, references: [{ratio: 0.95, worn: inches.ply}, "
      "{ratio: 0.95, worn_scan: millimetres.ply}]}]",
      true);
  ASSERT_EQ(cases.bodies.size(), 1u);
  ASSERT_EQ(cases.bodies[0].cases.size(), 2u);
  EXPECT_NE(cases.bodies[0].cases[0].name, cases.bodies[0].cases[1].name);
  for (const CalibrationCase& one : cases.bodies[0].cases) {
    EXPECT_GT(one.still, 0.001);  // m; B1 moves her so far
    EXPECT_LT(one.still, 0.01);
  }
}

TEST(NewtonsFile, HasWhatSettledAndIsFinite) {
  CalibrationCase one;
  one.newtons = {8, 10};
  const CaseOutcome settled{0, tensegric::Status::converged, 1, 0, {4, 20}, {}},
      slack{0, tensegric::Status::converged, 1, 0, {0, 20}, {}},
      capped{0, tensegric::Status::capped, 1, 0, {4, 20}, {}};
  ASSERT_TRUE(pull_ratio(one, settled));
  EXPECT_NEAR(*pull_ratio(one, settled), 1, 1e-9);
  ASSERT_TRUE(pull_ratio(one, slack));
  EXPECT_NEAR(*pull_ratio(one, slack), std::sqrt(kLeastPull / 8 * 2), 1e-9);
  EXPECT_FALSE(pull_ratio(one, capped));
  EXPECT_FALSE(pull_ratio(CalibrationCase(), settled));

  const auto text = [](const PullRatios& ratios) { return newtons_yaml(ratios, 120, "2026-11-27"); };
  EXPECT_NE(text({{"A 0.970", 0.5}, {"A 0.950", 2.0}}).find("half_width: 1.36 "), std::string::npos);
  EXPECT_EQ(refusal_of([&] { text({}); }), "too_few_data");
  for (const double ratio : {0.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(refusal_of([&] { text({{"A 0.970", 0.5}, {"A 0.950", ratio}}); }), "non_finite") << ratio;
}

TEST(Reference, OfAnotherMeshOrBrokenIsRefused) {
  geometry::TriangleMesh strip;
  for (int i = 0; i < 300; ++i) strip.vertices.emplace_back(0.01 * i, i % 2, 0);
  const std::string path =
      (std::filesystem::temp_directory_path() / ("reference_" + std::to_string(getpid()) + ".csv")).string();
  const auto code = [&](int rows, double shift, const std::string& last) {
    std::ofstream file(path);
    file << "vertex,x,y,z,dx,dy,dz,fixed\n";
    for (int i = 0; i < rows; ++i) file << i << "," << 0.01 * i + shift << "," << i % 2 << ",0,0.001,0,0,0\n";
    file << last;
    file.close();
    return refusal_of([&] { read_reference(path, strip); });
  };
  EXPECT_EQ(code(200, 0, ""), "none");
  EXPECT_EQ(code(50, 0, ""), "too_few_data");
  EXPECT_EQ(code(200, 0.002, ""), "wrong_reference");
  EXPECT_EQ(code(200, 0, "400,0,0,0,0,0,0,0\n"), "wrong_reference");
  EXPECT_EQ(code(200, 0, "7,0.07,1,0,0,0\n"), "broken_file");
  EXPECT_EQ(code(200, 0, "7,0.07,1,0,zero,0,0,0\n"), "broken_file");
  EXPECT_EQ(code(200, 0, "7,0.07,1,0,nan,0,0,0\n"), "broken_file");
  std::filesystem::remove(path);
  EXPECT_EQ(refusal_of([&] { read_reference(path, strip); }), "broken_file");
}

TEST(TissueFile, IsReadAsWrittenAndChecked) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("tissue_" + std::to_string(getpid()) + ".yaml")).string();
  const auto take = [&](const std::string& text) {
    std::ofstream(path) << text;
    fit::Settings settings;
    fit::take_tissue(path, settings);
    return settings;
  };
  fit::Settings truth;
  truth.model.inner = tensegric::InnerNodes::free;
  truth.model.skin = 0.0625;
  truth.model.layers = 3;
  truth.control_mesh.thickness = 0.75;
  EXPECT_EQ(tissue_yaml(take(tissue_yaml(truth) + "evidence: {anything: 1}\n")), tissue_yaml(truth));
  fit::Settings papers;
  fit::take_tissue(TENSEGRIC_FIT_SOURCE_DIR "/tests/benchmarks/papers.yaml", papers);
  truth = fit::Settings();
  truth.model = tensegric::papers_model();
  EXPECT_EQ(tissue_yaml(papers), tissue_yaml(truth));
  for (const char* bad : {"stiffness: 1\n", "skin: -1\n", "inner_nodes: loose\n", "thickness: much\n",
                          "layers: 0\n", "layers: 2.5\n", "[1, 2]\n"})
    EXPECT_EQ(refusal_of([&] { take(bad); }), "bad_option") << bad;
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace tensegric_fit::calibration
