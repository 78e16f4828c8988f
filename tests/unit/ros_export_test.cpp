/// What an export of a fit holds, without a master.
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "fit/fitted_folder.hpp"
#include "geometry/ply.hpp"
#include "mesh_files/read_mesh.hpp"
#include "ros_exported_scan.hpp"

namespace tensegric_fit::node {
namespace {

using nlohmann::json;

TEST_F(ExportFitTest, CorrelateReadsItAgain) {
  const fs::path folder = root_ / "one";
  export_fit(scan_, folder, kWhole);
  const fit::FittedFolder fitted = fit::read_fitted_folder(folder);
  EXPECT_EQ(fitted.scan, "scan 1.000000000-00000001");
  EXPECT_EQ(fitted.rest.triangles.size(), scan_.body->triangles.size() / 3);
  EXPECT_NEAR(fitted.deformed.at(0).x(), 0.9 * fitted.rest.vertices.at(0).x(), 1e-7);  // float32
  EXPECT_EQ(fitted.control.vertices.size(), 3u);
  ASSERT_EQ(fitted.lines.size(), 1u);
  EXPECT_EQ(fitted.lines[0].name, "chest");
  EXPECT_EQ(fitted.lines[0].request, 0.9);
  for (const char* text : {"{}", "[", "{\"scan\": {\"scan_id\": 1}}"}) {
    std::ofstream(folder / "fit.json") << text;
    EXPECT_THROW(fit::read_fitted_folder(folder), geometry::Refusal) << text;
  }
  fs::remove(folder / "fit.json");
  EXPECT_THROW(fit::read_fitted_folder(folder), geometry::Refusal);
}

TEST_F(ExportFitTest, WritesMeshesMeasuresPicturesAndParameters) {
  const fs::path folder = root_ / "one";
  EXPECT_EQ(export_fit(scan_, folder, kWhole).size(), 18u);
  const geometry::TriangleMesh deformed = geometry::read_ply_mesh(folder / "deformed.ply");
  EXPECT_EQ(deformed.triangles, geometry::read_ply_mesh(folder / "body.ply").triangles);
  EXPECT_NEAR(deformed.vertices.at(0).x(), 0.135, 1e-7);  // float32
  EXPECT_TRUE(geometry::read_ply_mesh(folder / "control_deformed.ply")
                  .vertices.at(2)
                  .isApprox(Eigen::Vector3d(0.09, 0.09, 1.3), 1e-15));
  for (const char* name : {"front.png", "side.png", "distortion.png"})
    EXPECT_GT(cv::imread((folder / name).string()).cols, 1000) << name;

  const json fit = json::parse(text_of(folder / "fit.json"));
  EXPECT_EQ(fit["scan"]["scan_id"], "1.000000000-00000001");
  EXPECT_EQ(fit["garment"]["name"], "B1\uFFFD");
  EXPECT_EQ(fit["garment"]["lines"][0]["neutral_mm"], 360);
  EXPECT_EQ(fit["body"]["girths"][0]["before_mm"], 942);
  // a tenth of the 60-cornered tape
  EXPECT_NEAR(fit["body"]["girths"][0]["after_mm"], 942 - 100 * 0.15 * 120 * std::sin(kPi / 60), 1e-3);
  EXPECT_TRUE(fit["body"]["girths"][1]["after_mm"].is_null());
  EXPECT_TRUE(fit["body"]["bra_size"]["before"].is_null()) << "the underbust is uncertain";
  EXPECT_TRUE(fit["body"]["bra_size"]["after"].is_null());
  EXPECT_NEAR(fit["body"]["landmarks"][0]["after_mm"][0], 135, 1e-3);
  EXPECT_EQ(fit["files"].size(), 18u);
  for (const std::string name : fit["files"]) EXPECT_GT(fs::file_size(folder / name), 0u) << name;
}

TEST_F(ExportFitTest, TheMeasuresForMakersAreThoseOfTheDocumentWithOrWithoutAHead) {
  for (const bool head : {true, false}) {
    const fs::path folder = root_ / (head ? "whole" : "headless");
    export_fit(scan_, folder, {head});
    const json body = json::parse(text_of(folder / "fit.json"))["body"],
               measures = json::parse(text_of(folder / "measures.json"))["measures"];
    ASSERT_EQ(measures.size(), body["heights"].size() + body["girths"].size());
    for (std::size_t i = 0; i < measures.size(); ++i) {
      const std::size_t heights = body["heights"].size();
      const json &measure = measures[i],
                 &said = i < heights ? body["heights"][i] : body["girths"][i - heights];
      EXPECT_EQ(measure["name"], said["name"]);
      EXPECT_NEAR(1e3 * measure["before"]["value"].get<double>(), said["before_mm"], 1e-3);
      ASSERT_EQ(measure["under_garment"].is_null(), said["after_mm"].is_null()) << measure["name"];
      if (said["after_mm"].is_null()) continue;
      EXPECT_NEAR(1e3 * measure["under_garment"]["value"].get<double>(), said["after_mm"], 1e-3);
    }
    const json& bust = measures[2];
    ASSERT_EQ(bust["name"], "bust");
    EXPECT_EQ(bust["iso_8559_1"]["number"], "5.3.4");
    EXPECT_EQ(bust["half_width"], 0.004);
    // a polygon of 60 corners and its section, before and at nine tenths of its width
    const double tape = 0.15 * 120 * std::sin(kPi / 60);
    EXPECT_NEAR(bust["before"]["tape"], tape, 1e-6);
    EXPECT_NEAR(bust["before"]["skin"], tape, 1e-5);
    EXPECT_NEAR(bust["under_garment"]["tape"], 0.9 * tape, 1e-5);
    EXPECT_EQ(bust["before"]["polyline"].size(), 60u);
    EXPECT_NEAR(bust["before"]["polyline"][0][1], 1.21, 1e-9) << "y up";
    EXPECT_NE(text_of(folder / "measures.vit").find("<m name=\"bust_circ\" value=\"94.2\""),
              std::string::npos);
    EXPECT_NE(text_of(folder / "measures_worn.vit").find("<m name=\"bust_circ\" value=\"84.8\""),
              std::string::npos);
  }
}

TEST_F(ExportFitTest, TheDocumentIsWhatItsSchemaSays) {
  export_fit(scan_, root_ / "one", kWhole);
  EXPECT_TRUE(is_valid(root_ / "one" / "fit.json"));
  const json good = json::parse(text_of(root_ / "one" / "fit.json"));
  const auto accepts = [&](const json::json_pointer& where, const json& value) {
    json other = good;
    other[where] = value;
    std::ofstream(root_ / "other.json") << other;
    return is_valid(root_ / "other.json");
  };
  EXPECT_TRUE(accepts("/garment/name"_json_pointer, "B2"));
  EXPECT_FALSE(accepts("/version"_json_pointer, 2));
  EXPECT_FALSE(accepts("/garment/lines/0/neutral_mm"_json_pointer, nullptr));
  EXPECT_FALSE(accepts("/garment/lines/0/law"_json_pointer, "soft"));
  EXPECT_FALSE(accepts("/garment/lines/0/law"_json_pointer, json{{"stiffness", 0}}));
  EXPECT_FALSE(accepts("/body/bra_size/before"_json_pointer, "large"));
  EXPECT_FALSE(accepts("/body/girths/0/confidence"_json_pointer, 1.5));
}

TEST_F(ExportFitTest, TheMakerLearnsHowEachBandResists) {
  auto fit = boost::make_shared<FitState>(*scan_.fit);
  fit->lines.resize(3, fit->lines[0]);
  fit->lines[1].law = GarmentLine::STIFFNESS;
  fit->lines[1].stiffness = 2.5;
  fit->lines[1].tension_limit = 0.5;
  fit->lines[2].law = GarmentLine::TABLE;
  fit->lines[2].table_stretch = {1, 1.2};
  fit->lines[2].table_tension = {0, 3};
  FittedScan scan = scan_;
  scan.fit = fit;
  export_fit(scan, root_ / "one", kWhole);
  EXPECT_TRUE(is_valid(root_ / "one" / "fit.json"));
  const json lines = json::parse(text_of(root_ / "one" / "fit.json"))["garment"]["lines"];
  EXPECT_EQ(lines[0]["law"], "rigid");
  EXPECT_TRUE(lines[0]["tension_limit"].is_null());
  EXPECT_EQ(lines[1]["law"], json::parse(R"({"stiffness": 2.5})"));
  EXPECT_EQ(lines[1]["tension_limit"], 0.5);
  EXPECT_EQ(lines[2]["law"], json::parse(R"({"table": [[1, 0], [1.2, 3]]})"));
}

TEST_F(ExportFitTest, ForcesAreWrittenWhereTheyAreOfThisFit) {
  const auto forces = boost::make_shared<LineForces>();
  forces->scan_id = scan_.fit->scan_id;
  forces->garment = scan_.fit->garment;
  forces->lines = {"chest"};
  forces->tension = {scan_.fit->lines[0].tension};
  forces->newtons = {12.5};
  forces->kilopascals = {1.25};
  scan_.forces = forces;
  export_fit(scan_, root_ / "one", kWhole);
  EXPECT_TRUE(is_valid(root_ / "one" / "fit.json"));
  json line = json::parse(text_of(root_ / "one" / "fit.json"))["garment"]["lines"][0];
  EXPECT_EQ(line["tension_N"], 12.5);
  EXPECT_EQ(line["pressure_kPa"], 1.25);
  forces->tension[0] += 0.1;
  export_fit(scan_, root_ / "other", kWhole);
  line = json::parse(text_of(root_ / "other" / "fit.json"))["garment"]["lines"][0];
  EXPECT_FALSE(line.contains("tension_N"));
}

/// What goes beyond the neck's plane with the head has its middle far from the neck.
TEST_F(ExportFitTest, AHeadThatIsJoinedToSomethingBesideItIsNotExportedAsNone) {
  geometry::TriangleMesh mesh = tube();
  const int top = static_cast<int>(mesh.vertices.size()) - 1;
  for (int i = 0; i < 1000; ++i) {
    mesh.vertices.emplace_back(1, 0.001 * i, 1.4);
    mesh.triangles.emplace_back(top, top + i, top + i + 1);
  }
  mesh.triangles[mesh.triangles.size() - 1000] = {top, top - 1, top + 1};
  scan_.body = boost::make_shared<TriangleMesh>(to_message(tag_in(*scan_.body), mesh, {}));
  const auto deformed = boost::make_shared<DeformedMesh>(*scan_.deformed);
  deformed->vertices = scan_.body->vertices;
  deformed->distortion.assign(mesh.vertices.size(), 0.9F);
  scan_.deformed = deformed;
  EXPECT_EQ(refused(scan_, root_ / "whole"), "");
  try {
    export_fit(scan_, root_ / "headless", {});
    ADD_FAILURE();
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "missing_part:neck");
  }
  EXPECT_FALSE(fs::exists(root_ / "headless"));
}

/// Of a head that is held forward: the back of the cut's rim is higher than a head need be.
TEST_F(ExportFitTest, AHeadIsCutOffInAPlaneThatLeans) {
  const auto landmarks = boost::make_shared<Landmarks>(*scan_.landmarks);
  for (GirthLoop& loop : landmarks->loops)
    if (loop.name == "neck")
      for (std::size_t i = 0; i < loop.points.size(); i += 3)
        loop.points[i + 2] = 1.25 + std::tan(40 * kPi / 180) * loop.points[i + 1];
  scan_.landmarks = landmarks;
  export_fit(scan_, root_ / "one", {});
  const geometry::TriangleMesh body = geometry::read_ply_mesh(root_ / "one" / "body.ply");
  for (const Eigen::Vector3d& v : body.vertices) EXPECT_LT(v.z(), 1.28 + std::tan(40 * kPi / 180) * v.y());
}

TEST_F(ExportFitTest, TheHeadIsCutOffJustAboveTheTapeOfTheNeck) {
  export_fit(scan_, root_ / "whole", kWhole);
  const fs::path folder = root_ / "one";
  export_fit(scan_, folder, {});
  const geometry::TriangleMesh whole = geometry::read_ply_mesh(root_ / "whole" / "body.ply"),
                               body = geometry::read_ply_mesh(folder / "body.ply"),
                               deformed = geometry::read_ply_mesh(folder / "deformed.ply");
  EXPECT_NEAR(geometry::bounding_box(whole.vertices)[1].z(), 1.4, 1e-6);
  EXPECT_NEAR(geometry::bounding_box(body.vertices)[1].z(), 1.339, 1e-6);
  EXPECT_NEAR(geometry::bounding_box(deformed.vertices)[1].z(), 1.339, 1e-6);
  EXPECT_EQ(body.triangles, deformed.triangles);
  ASSERT_EQ(body.vertices.size(), deformed.vertices.size());
  for (std::size_t v = 0; v < body.vertices.size(); ++v)  // the tube at nine tenths of its width, cut or not
    EXPECT_LT((deformed.vertices[v] - Eigen::Vector3d(0.9, 0.9, 1).asDiagonal() * body.vertices[v]).norm(),
              1e-6);
  const auto rims = [](const geometry::TriangleMesh& mesh) {
    const auto edges = geometry::edges_of(mesh);
    return std::count_if(edges.begin(), edges.end(),
                         [](const geometry::Edge& edge) { return edge.right < 0; });
  };
  EXPECT_EQ(rims(whole), 120);
  EXPECT_EQ(rims(body), 60) << "the cut is closed, the tube's lower end stays open";
  const json fit = json::parse(text_of(folder / "fit.json"));
  EXPECT_EQ(fit["body"]["head"], false);
  EXPECT_EQ(fit["body"]["heights"][1]["before_mm"], 1700);  // stature
  EXPECT_TRUE(is_valid(folder / "fit.json"));
  EXPECT_LT(fs::file_size(folder / "fit.glb"), fs::file_size(root_ / "whole" / "fit.glb"));
  for (const auto& [name, of] : {std::pair("body", &body), {"deformed", &deformed}})
    for (const char* ending : {".obj", ".stl"}) {
      const geometry::TriangleMesh read = mesh_files::read_mesh(folder / (std::string(name) + ending));
      const auto box = geometry::bounding_box(read.vertices), true_box = geometry::bounding_box(of->vertices);
      EXPECT_EQ(read.triangles.size(), of->triangles.size()) << name << ending;
      EXPECT_NEAR(box[1].y(), 1339, 1e-2) << name << ending << ": millimetres, y up";
      EXPECT_NEAR(box[1].x(), 1e3 * true_box[1].y(), 1e-2) << name << ending << ": x to her left";
    }
}

TEST_F(ExportFitTest, WithoutANeckNothingIsExportedButOnRequest) {
  const auto landmarks = boost::make_shared<Landmarks>(*scan_.landmarks);
  landmarks->loops.clear();
  scan_.landmarks = landmarks;
  try {
    export_fit(scan_, root_ / "one", {});
    FAIL();
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "missing_part:neck");
  }
  EXPECT_FALSE(fs::exists(root_ / "one"));
  EXPECT_EQ(export_fit(scan_, root_ / "one", kWhole).size(), 18u);
}

TEST_F(ExportFitTest, WhatDoesNotFitTogetherOrIsNoNumberIsNotExported) {
  const auto spoilt = [this](const auto& spoil) {
    FittedScan scan = fitted("2.000000000-00000002");
    const auto fit = boost::make_shared<FitState>(*scan.fit);
    const auto deformed = boost::make_shared<DeformedMesh>(*scan.deformed);
    spoil(*fit, *deformed);
    scan.fit = fit;
    scan.deformed = deformed;
    const std::string code = refused(scan, root_ / "spoilt");
    EXPECT_FALSE(fs::exists(root_ / "spoilt"));
    return code;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(spoilt([](FitState& fit, DeformedMesh&) { fit.lines[0].neutral = kNan; }), "non_finite");
  EXPECT_EQ(spoilt([](FitState& fit, DeformedMesh&) { fit.lines[0].stiffness = kNan; }), "non_finite");
  EXPECT_EQ(spoilt([](FitState& fit, DeformedMesh&) { fit.lines[0].table_stretch = {1}; }), "bad_mesh");
  EXPECT_EQ(spoilt([](FitState& fit, DeformedMesh&) { fit.lines[0].nodes[0] = 99; }), "bad_mesh");
  EXPECT_EQ(spoilt([](FitState& fit, DeformedMesh&) { fit.outer.resize(6); }), "bad_mesh");
  EXPECT_EQ(spoilt([](FitState&, DeformedMesh& deformed) { deformed.vertices.resize(9); }), "bad_mesh");
  EXPECT_EQ(spoilt([](FitState&, DeformedMesh& deformed) { deformed.distortion.clear(); }), "bad_mesh");
}

}  // namespace
}  // namespace tensegric_fit::node
