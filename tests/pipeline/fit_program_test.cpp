/// What `fit` computes and writes.
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "fit_program.hpp"
#include "geometry/ply.hpp"
#include "mesh_files/read_mesh.hpp"

namespace {

TEST_F(FitProgram, WritesEveryFieldAndFile) {
  ASSERT_EQ(fit("--scan " + kScans + "/a/scan.ply --garment B1 --ratio chest=0.90"), 0)
      << read_file(file("log"));
  for (const char* name : kResults) EXPECT_GT(fs::file_size(folder_ / "out" / name), 0u) << name;
  const json r = report();
  EXPECT_EQ(r["status"], "ok");
  EXPECT_TRUE(r["reason"].is_null());
  EXPECT_EQ(r["scan"]["body_from_scan"].size(), 4u);
  EXPECT_LE(r["scan"]["points_used"], r["scan"]["points"]);
  for (const char* stage : {"reconstruction", "body_model", "landmarks", "control_mesh", "tensegric", "tffd"})
    EXPECT_GT(r["stages"][stage]["ms"], 0) << stage;
  EXPECT_TRUE(r["body"]["closed"]);
  for (const char* name :
       {"bust_point_L", "bust_point_R", "shoulder_L", "shoulder_R", "neck_front", "neck_back", "neck_side_L",
        "neck_side_R", "axilla_L", "axilla_R", "crotch", "navel"})
    EXPECT_EQ(r["landmarks"][name]["position"].size(), 3u) << name;
  for (const char* name : {"bust", "underbust", "waist", "hip", "crotch", "neck", "stature"})
    EXPECT_TRUE(r["heights"][name].is_number()) << name;
  for (const char* name : {"bust", "underbust", "waist", "hip", "neck"})
    EXPECT_TRUE(r["girths"][name].is_number()) << name;
  EXPECT_EQ(r["control"]["nodes"], 77);
  EXPECT_EQ(r["control"]["triangles"], 120);
  EXPECT_EQ(r["control"]["struts"], 360);
  EXPECT_EQ(r["control"]["tensile_parts"], 469);
  EXPECT_EQ(r["solver"]["status"], "converged");
  EXPECT_LE(r["solver"]["residual"], 1e-8);  // nodes/tensegric/README.md, Exactness
  const json& line = r["lines"].at(0);
  EXPECT_EQ(line["request"], 0.9);
  EXPECT_NEAR(line["ratio"].get<double>(), 0.9, 1e-6);  // nodes/tensegric/README.md, Exactness
  EXPECT_GT(line["tension"], 0);
  const json& volume = r["regions"].at(0)["control_volume"];
  EXPECT_NEAR(volume[1].get<double>() / volume[0].get<double>(), 1,
              1e-9);  // nodes/tensegric/README.md, Exactness
  EXPECT_LT(r["distortion"]["min"], 1);
  const auto body = tensegric_fit::geometry::read_ply_mesh(file("out/body.ply"));
  const auto deformed = tensegric_fit::geometry::read_ply_mesh(file("out/deformed.ply"));
  EXPECT_EQ(body.vertices.size(), r["body"]["vertices"]);
  EXPECT_EQ(body.triangles, deformed.triangles);  // the same vertex order
  EXPECT_EQ(read_file(file("out/history.csv")).substr(0, 10), "iteration,");
}

TEST_F(FitProgram, SaysWhatIsTooMuchAndWhatIsTooLittle) {
  const auto codes = [&](const char* list) {
    std::set<std::string> found;
    const json all = report();
    for (const json& entry : all[list]) {
      found.insert(entry["code"]);
      EXPECT_FALSE(entry["message"].get<std::string>().empty());
      EXPECT_EQ(entry["place"].size(), 3u);
    }
    return found;
  };
  const std::string body = "--mesh " + kScans + "/a/body.ply --garment B1 --ratio ";
  ASSERT_EQ(fit(body + "0.95"), 0) << read_file(file("log"));
  EXPECT_TRUE(codes("warnings").empty());
  EXPECT_TRUE(report()["distortion"]["under_constricted"].empty());
  ASSERT_EQ(fit(body + "1"), 0) << read_file(file("log"));
  EXPECT_TRUE(codes("warnings").empty());
  EXPECT_EQ(codes("notices"), std::set<std::string>{"under_constricted"});
  EXPECT_EQ(report()["notices"].at(0)["lack"], "slack");
  EXPECT_GT(report()["distortion"]["under_constricted"].size(), 10u);
  ASSERT_EQ(fit(body + "0.75"), 0) << read_file(file("log"));
  EXPECT_EQ(report()["distortion"]["over_stretched"].size() > 0, report()["distortion"]["max"] > 1.25);
  EXPECT_EQ(report()["distortion"]["over_constricted"].size() > 0, report()["distortion"]["min"] < 0.8);
  EXPECT_EQ(codes("warnings").count("shelf"), 1u);
  const json shelf = report()["warnings"].at(0);
  EXPECT_EQ(shelf["line"], "chest");
  EXPECT_GT(shelf["largest_turn_deg"], 60);
  EXPECT_GE(shelf["area_cm2"], shelf["shelf_cm2"]);
}

TEST_F(FitProgram, SaysTheSameTwice) {
  const std::string arguments = "--scan " + kScans + "/b/scan.bag --garment B1 --body-triangles 20000";
  ASSERT_EQ(fit(arguments, "one"), 0) << read_file(file("log"));
  ASSERT_EQ(fit(arguments, "two"), 0) << read_file(file("log"));
  for (const char* name : kResults) {
    if (std::string(name) == "report.json") continue;  // holds times
    EXPECT_EQ(read_file(folder_ / "one" / name), read_file(folder_ / "two" / name)) << name;
  }
}

TEST_F(FitProgram, MeasuresOnlyWithoutAGarmentAndTakesAMeshAsItIs) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply"), 0) << read_file(file("log"));
  const json r = report();
  EXPECT_FALSE(r.contains("lines"));
  EXPECT_FALSE(fs::exists(file("out/deformed.ply")));
  const auto given = tensegric_fit::geometry::read_ply_mesh(kScans + "/a/body.ply");
  EXPECT_EQ(r["body"]["vertices"], given.vertices.size());
  const json truth = json::parse(read_file(kScans + "/a/truth.json"));
  EXPECT_GT(r["body_model"]["residual"], 0);
  EXPECT_LT(r["body_model"]["residual"], 0.01);
  EXPECT_NEAR(r["body_model"]["stature"].get<double>(), r["heights"]["stature"].get<double>(), 0.1);
  EXPECT_GT(r["body_model"]["shape"].size(), 10u);
  EXPECT_EQ(r["body_model"]["pose"]["arm_L"].size(), 3u);
  EXPECT_LT(r["body_model"]["up_deviation_deg"], 5);
  EXPECT_GT(r["landmarks"]["crotch"]["half_width"], 0);
  EXPECT_GT(r["confidence"]["heights"]["bust"]["half_width"], 0);
  for (const char* girth : {"bust", "underbust", "waist", "hip"})  // ISO 20685 allows 9 mm on large girths
    EXPECT_NEAR(r["girths"][girth].get<double>(), truth["girths"][girth].get<double>(), 0.009) << girth;
}

TEST_F(FitProgram, ShowsTheBodyModelOverTheBodyWhereAskedTo) {
  const std::string measured = "--mesh " + kScans + "/a/body.ply";
  ASSERT_EQ(fit(measured, "plain"), 0) << read_file(file("log"));
  ASSERT_EQ(fit(measured + " --overlay", "overlay"), 0) << read_file(file("log"));
  for (const char* name : {"front.png", "side.png"}) {
    const cv::Mat plain = cv::imread(folder_ / "plain" / name),
                  overlay = cv::imread(folder_ / "overlay" / name);
    ASSERT_FALSE(plain.empty()) << name;
    ASSERT_EQ(plain.size(), overlay.size()) << name;
    cv::Mat difference;
    cv::absdiff(plain, overlay, difference);
    const double changed = cv::countNonZero(difference.reshape(1)), values = 3.0 * plain.total();
    EXPECT_GT(changed, 0.05 * values) << name << ": her parts are coloured";  // 0.13
  }
  EXPECT_EQ(read_file(folder_ / "overlay" / "body.ply"), read_file(folder_ / "plain" / "body.ply"));
}

TEST_F(FitProgram, AnInfeasibleRequestIsDoneAndSaysSo) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment B1 --ratio 0.3"), 0) << read_file(file("log"));
  EXPECT_EQ(report()["solver"]["status"], "infeasible");
}

TEST_F(FitProgram, ABandGivesWay) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment B1 --ratio chest=0.9 --band 0.5"), 0)
      << read_file(file("log"));
  const json line = report()["lines"].at(0);
  const double stretch = line["final"].get<double>() / line["neutral"].get<double>() - 1;
  EXPECT_GT(stretch, 0);
  EXPECT_NEAR(line["tension"].get<double>(), 0.5 * stretch,
              1e-8);  // the law of the band, at the residual's tolerance
}

TEST_F(FitProgram, FinerControlMeshesHaveTissueInLayers) {
  for (const char* volume : {"control", "body"}) {
    ASSERT_EQ(fit("--mesh " + kScans +
                  "/a/body.ply --garment B1+H2 --ratio 0.95 --control-triangles 480 --volume " + volume),
              0)
        << read_file(file("log"));
    const json r = report();
    EXPECT_EQ(r["solver"]["status"], "converged");
    EXPECT_EQ(r["control"]["struts"].get<int>(), 3 * 3 * r["control"]["triangles"].get<int>());
    for (const json& line : r["lines"])
      EXPECT_NEAR(line["ratio"].get<double>(), 0.95, 1e-6);  // nodes/tensegric/README.md, Exactness
    for (const json& region : r["regions"]) {
      const json& kept = region[std::string(volume) + "_volume"];
      EXPECT_NEAR(kept[1].get<double>() / kept[0].get<double>(), 1,
                  1e-9);  // nodes/tensegric/README.md, Exactness
    }
  }
}

// The hips' template has 160 triangles as it is.
TEST_F(FitProgram, OnlyATemplateThatIsMadeFinerHasTissueInLayers) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment H1 --ratio 0.95 --control-triangles 140"), 0)
      << read_file(file("log"));
  const json r = report();
  EXPECT_EQ(r["control"]["triangles"], 160);
  EXPECT_EQ(r["control"]["struts"], 3 * 160);  // one layer
  EXPECT_NE(fit("--mesh " + kScans + "/a/body.ply --garment B1+H1 --ratio 0.95 --control-triangles 140"), 0);
  EXPECT_NE(read_file(file("log")).find("140 control triangles make 'bust' finer"), std::string::npos)
      << read_file(file("log"));
}

TEST_F(FitProgram, AGarmentIsWornInAnyPosture) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment B1 --ratio 0.95 --twist 15 --lean -10"), 0)
      << read_file(file("log"));
  const json r = report();
  EXPECT_NEAR(r["posture"]["twist"].get<double>(), 15, 1e-12);
  EXPECT_NEAR(r["posture"]["lean"].get<double>(), -10, 1e-12);
  EXPECT_TRUE(r["warnings"].empty());
  EXPECT_EQ(r["solver"]["status"], "converged");
  EXPECT_NEAR(r["lines"].at(0)["ratio"].get<double>(), 0.95, 1e-6);  // nodes/tensegric/README.md, Exactness
  const json& volume = r["regions"].at(0)["control_volume"];
  EXPECT_NEAR(volume[1].get<double>() / volume[0].get<double>(), 1,
              1e-9);  // nodes/tensegric/README.md, Exactness
  const auto body = tensegric_fit::geometry::read_ply_mesh(file("out/body.ply"));
  const auto moved = tensegric_fit::geometry::read_ply_mesh(file("out/deformed.ply"));
  const double hip = r["heights"]["hip"], neck = r["heights"]["neck"];
  for (std::size_t v = 0; v < body.vertices.size(); ++v) {
    const double z = body.vertices[v].z(), way = (moved.vertices[v] - body.vertices[v]).norm();
    if (z < hip - 0.02) {
      ASSERT_EQ(way, 0);  // the scan is upright
    } else if (z > neck) {
      ASSERT_GT(way, 0.03);  // 10 degrees over half a metre and more is 80 mm
    }
  }
}

TEST_F(FitProgram, TheBodysVolumeIsKeptInAPosture) {
  ASSERT_EQ(
      fit("--mesh " + kScans + "/a/body.ply --garment B1 --ratio 0.95 --volume body --twist 15 --lean -10"),
      0)
      << read_file(file("log"));
  const json r = report();
  EXPECT_EQ(r["solver"]["status"], "converged");
  const json& volume = r["regions"].at(0)["body_volume"];
  EXPECT_NEAR(volume[1].get<double>() / volume[0].get<double>(), 1,
              1e-9);  // nodes/tensegric/README.md, Exactness
}

TEST_F(FitProgram, BendsAnyShapeUnderGravity) {
  // a bar along x, fixed at x = 0
  tensegric_fit::geometry::TriangleMesh bar;
  const int rings = 13;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < 4; ++k)
      bar.vertices.emplace_back(0.02 * i, 0.02 * (k == 0 || k == 3 ? -1 : 1), 0.02 * (k < 2 ? -1 : 1));
  for (int i = 0; i + 1 < rings; ++i) {
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      bar.triangles.emplace_back(a, b, b + 4);
      bar.triangles.emplace_back(a, b + 4, a + 4);
    }
  }
  const int end = 4 * (rings - 1);
  bar.triangles.insert(bar.triangles.end(),
                       {{0, 3, 1}, {1, 3, 2}, {end, end + 1, end + 3}, {end + 1, end + 2, end + 3}});
  if (tensegric_fit::geometry::cone_volume(bar.vertices, bar.triangles) < 0)
    for (auto& t : bar.triangles) std::swap(t[1], t[2]);
  tensegric_fit::geometry::write_ply_mesh(file("bar.ply"), bar);
  write("fixed.yaml", "nodes: [0, 1, 2, 3]\n");
  ASSERT_EQ(fit("--mesh " + file("bar.ply") + " --control " + file("bar.ply") + " --fixed " +
                file("fixed.yaml") + " --gravity 0,0,-0.5"),
            0)
      << read_file(file("log"));
  const auto bent = tensegric_fit::geometry::read_ply_mesh(file("out/deformed.ply"));
  EXPECT_LT((bent.vertices[0] - bar.vertices[0]).norm(), 1e-6);  // float32
  EXPECT_LT(bent.vertices[end].z(), bar.vertices[end].z() - 1e-3);
  for (Eigen::Vector3d& vertex : bar.vertices) vertex *= 1e3;
  tensegric_fit::geometry::write_ply_mesh(file("bar.ply"), bar);
  ASSERT_EQ(fit("--mesh " + file("bar.ply") + " --unit mm --control " + file("bar.ply") + " --fixed " +
                file("fixed.yaml") + " --gravity 0,0,-0.5"),
            0)
      << read_file(file("log"));
  const auto same = tensegric_fit::geometry::read_ply_mesh(file("out/deformed.ply"));
  for (std::size_t v = 0; v < same.vertices.size(); ++v)
    EXPECT_LT((same.vertices[v] - bent.vertices[v]).norm(), 1e-4) << v;  // m
}

TEST_F(FitProgram, ExportsForMakers) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment B1 --export obj,glb,stl"), 0)
      << read_file(file("log"));
  const auto body = tensegric_fit::geometry::read_ply_mesh(file("out/body.ply"));
  for (const char* name : {"body.obj", "deformed.obj", "body.stl", "deformed.stl"}) {
    const auto mesh = tensegric_fit::mesh_files::read_mesh(file(std::string("out/") + name));
    EXPECT_EQ(mesh.triangles.size(), body.triangles.size()) << name;
    EXPECT_TRUE(tensegric_fit::geometry::is_closed(mesh)) << name;
    EXPECT_GT(tensegric_fit::geometry::cone_volume(mesh.vertices, mesh.triangles), 3e7)
        << name;  // mm^3, outward
    const auto box = tensegric_fit::geometry::bounding_box(mesh.vertices);
    EXPECT_NEAR(box[0].y(), 0, 20) << name;  // y up, on the floor
  }
  const std::string glb = read_file(file("out/fit.glb"));
  EXPECT_NE(glb.find("under the garment"), std::string::npos);
  EXPECT_NE(glb.find("_DISTORTION"), std::string::npos);
  EXPECT_NE(glb.find("line chest"), std::string::npos);
  const json said = report(), measures = json::parse(read_file(file("out/measures.json")));
  EXPECT_EQ(measures["measures"].size(), said["heights"].size() + said["girths"].size());
  for (const json& measure : measures["measures"]) {
    const std::string kind = measure["kind"], name = measure["name"];
    EXPECT_EQ(measure["before"]["value"], said[kind + "s"][name]) << name;
    if (kind != "girth") continue;
    for (const char* when : {"before", "under_garment"}) {
      const json& loop = measure[when];
      EXPECT_NEAR(loop["tape"].get<double>(), loop["value"].get<double>(), 5e-4) << name;
      EXPECT_GE(loop["skin"].get<double>(), loop["tape"].get<double>() - 2e-3) << name;
      EXPECT_LE(loop["skin"].get<double>(), 1.1 * loop["tape"].get<double>()) << name;
    }
  }
  const std::string vit = read_file(file("out/measures.vit")), neck = "<m name=\"height_neck_back\" value=\"";
  EXPECT_NE(vit.find("<m name=\"bust_circ\""), std::string::npos);
  ASSERT_NE(vit.find(neck), std::string::npos);
  const json &up = said["scan"]["body_from_scan"][2], &back = said["landmarks"]["neck_back"]["position"];
  double height = up[3];
  for (int k = 0; k < 3; ++k) height += up[k].get<double>() * back[k].get<double>();
  EXPECT_NEAR(std::stod(vit.substr(vit.find(neck) + neck.size())), 100 * height, 0.06);  // cm, to the tenth
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply"), 0);  // old ones are never taken for new ones
  EXPECT_FALSE(fs::exists(folder_ / "out" / "fit.glb"));
}

}  // namespace
