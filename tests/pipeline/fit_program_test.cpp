// The program `fit` as its users start it: files in, files and an exit code out.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <tuple>

#include "geometry/ply.hpp"
#include "mesh_files/glb.hpp"
#include "mesh_files/maker_files.hpp"
#include "mesh_files/read_mesh.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kScans = TENSEGRIC_FIT_SCANS;
const std::string kFit = std::string(TENSEGRIC_FIT_PROGRAMS) + "/fit";
const char* const kResults[] = {"report.json",   "body.ply",    "control.ply", "control_deformed.ply",
                                "deformed.ply",  "history.csv", "front.png",   "side.png",
                                "distortion.png"};

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class FitProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tensegric_fit_program_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  // Exit code of fit; -1 where a signal ended it.
  int fit(const std::string& arguments, const std::string& out = "out") const {
    const int status = std::system(
        (kFit + " " + arguments + " --quiet --out " + file(out) + " > " + file("log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  json report(const std::string& out = "out") const {
    return json::parse(read_file(folder_ / out / "report.json"));
  }

  void expect_refused(const std::string& arguments, const std::string& code) const {
    EXPECT_EQ(fit(arguments), 3) << read_file(file("log"));
    const json said = report();
    EXPECT_EQ(said["status"], "refused");
    EXPECT_EQ(said["reason"]["code"], code) << said["reason"]["message"];
    EXPECT_FALSE(said["reason"]["message"].get<std::string>().empty());
    for (const char* name : kResults)
      EXPECT_EQ(fs::exists(folder_ / "out" / name), std::string(name) == "report.json") << name;
  }

  fs::path folder_;
};

using Generator = std::function<Eigen::Vector3f(std::mt19937&)>;

std::string ply_of(std::size_t count, const Generator& point, const std::string& fields = "xyz") {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (char field : fields) text += std::string("property float ") + field + "\n";
  text += "end_header\n";
  std::mt19937 random(7);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = point(random);
    text.append(reinterpret_cast<const char*>(p.data()), 12);
  }
  return text;
}

float uniform(std::mt19937& random) {
  return static_cast<float>(random() / 4294967296.0);
}

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

// A scan cut at the plane x = 0 in two files.
std::array<std::string, 2> halves_of(const std::string& ply) {
  const std::string element = "element vertex ", end = "end_header\n";
  const std::size_t at = ply.find(element) + element.size(), line = ply.find('\n', at),
                    start = ply.find(end) + end.size();
  const std::size_t count = std::stoul(ply.substr(at, line - at)), stride = (ply.size() - start) / count;
  std::array<std::string, 2> halves;
  std::array<std::size_t, 2> counts{};
  for (std::size_t i = start; i + stride <= ply.size(); i += stride) {
    float x;
    std::memcpy(&x, &ply[i], 4);
    const int half = x < 0 ? 0 : 1;
    halves[half].append(ply, i, stride);
    ++counts[half];
  }
  for (int h = 0; h < 2; ++h)
    halves[h] = ply.substr(0, at) + std::to_string(counts[h]) + ply.substr(line, start - line) + halves[h];
  return halves;
}

TEST_F(FitProgram, TakesSeveralFilesOfOnePerson) {
  const auto [left, right] = halves_of(read_file(kScans + "/a/scan.ply"));
  ASSERT_EQ(fit("--scan " + kScans + "/a/scan.ply"), 0) << read_file(file("log"));
  const json whole = report();
  const std::string a = write("a.ply", left), b = write("b.ply", right);
  ASSERT_EQ(fit("--scan " + a + " --scan " + b), 0) << read_file(file("log"));
  const json both = report();
  EXPECT_EQ(both["scan"]["points"], whole["scan"]["points"]);
  EXPECT_EQ(both["scan"]["file"], a);
  EXPECT_EQ(both["scan"]["more_files"], json::array({b}));
  for (const char* girth : {"bust", "underbust", "waist", "hip"})  // the same points in another order
    EXPECT_NEAR(both["girths"][girth].get<double>(), whole["girths"][girth].get<double>(), 0.002) << girth;
  EXPECT_EQ(fit("--scan " + a + " " + b), 2) << "each file needs its --scan";
  write("none.ply", ply_of(0, [](std::mt19937&) { return Eigen::Vector3f(); }));
  expect_refused("--scan " + a + " --scan " + file("none.ply"), "empty_cloud");
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
    // colours and lines make a larger file than plain skin does
    EXPECT_GT(fs::file_size(folder_ / "overlay" / name), 1.2 * fs::file_size(folder_ / "plain" / name))
        << name;
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

TEST_F(FitProgram, TakesControlMeshesOfOnesOwn) {
  const std::string worn = "--mesh " + kScans +
                           "/a/body.ply --garment B1 --ratio 0.95 --control-triangles 60 --templates " +
                           folder_.string();
  expect_refused(worn, "bad_garment");  // no template of the bust there
  fs::copy_file(TENSEGRIC_FIT_SOURCE_DIR "/tests/benchmarks/bust_60.yaml", folder_ / "bust.yaml");
  ASSERT_EQ(fit(worn), 0) << read_file(file("log"));
  const json r = report();
  EXPECT_EQ(r["control"]["triangles"], 60);
  EXPECT_NEAR(r["lines"].at(0)["ratio"].get<double>(), 0.95, 1e-6);  // nodes/tensegric/README.md, Exactness
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
}

TEST_F(FitProgram, UsageErrorsAreTwo) {
  EXPECT_EQ(fit(""), 2);
  EXPECT_EQ(fit("--scan a.ply --nonsense"), 2);
  EXPECT_EQ(fit("--scan a.ply --garment B1 --ratio tight"), 2);
  EXPECT_EQ(fit("--scan a.ply --garment B1 --ratio chest=-1"), 2);
  EXPECT_EQ(fit("--scan a.ply --garment B1 --solver magic"), 2);
  EXPECT_EQ(fit("--scan a.ply --garment B1 --band loose"), 2);
  EXPECT_EQ(fit("--scan a.ply --mesh b.ply"), 2);
  EXPECT_EQ(fit("--scan a.ply --body-triangles 3"), 2);
  EXPECT_EQ(fit("--scan a.ply --garment ''"), 2);  // an unset variable of a script is not "measure only"
  EXPECT_EQ(fit("--mesh a.ply --gravity 0,0,-1"), 2);
  EXPECT_EQ(fit("--mesh a.ply --fixed b.yaml --overlay"), 2);  // a shape has no body model
  EXPECT_EQ(fit("--scan a.ply --twist 15"), 2);                // nothing to show it with
  EXPECT_EQ(fit("--scan a.ply --garment B1 --twist 61"), 2);
  EXPECT_EQ(fit("--help"), 0);
}

TEST_F(FitProgram, NeverOverwritesAnInput) {
  fs::create_directories(file("out"));
  fs::copy_file(kScans + "/a/body.ply", file("out/body.ply"));
  const std::string before = read_file(file("out/body.ply"));
  EXPECT_EQ(fit("--mesh " + file("out/../out/body.ply")), 2);
  EXPECT_TRUE(read_file(file("out/body.ply")) == before);
}

TEST_F(FitProgram, AnInsideOutControlMeshIsRefused) {
  tensegric_fit::geometry::TriangleMesh shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                              {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  ASSERT_LT(tensegric_fit::geometry::cone_volume(shape.vertices, shape.triangles), 0);
  tensegric_fit::geometry::write_ply_mesh(file("shape.ply"), shape);
  write("fixed.yaml", "nodes: [0, 1, 2]\n");
  expect_refused(
      "--mesh " + file("shape.ply") + " --control " + file("shape.ply") + " --fixed " + file("fixed.yaml"),
      "bad_mesh");
}

TEST_F(FitProgram, NamesOfAnyBytesReachTheReport) {
  expect_refused("--scan " + file("br\xfcste.ply"), "broken_file");
}

TEST_F(FitProgram, RefusesBadScansByName) {
  const auto nan = [](std::mt19937&) { return Eigen::Vector3f(NAN, NAN, NAN); };
  const auto box = [](std::mt19937& random) {
    Eigen::Vector3f p(uniform(random), uniform(random), uniform(random));
    p[static_cast<int>(random() % 3)] = static_cast<float>(random() % 2);
    return Eigen::Vector3f(p.cwiseProduct(Eigen::Vector3f(0.5f, 0.4f, 1.7f)));
  };
  const auto direction = [](std::mt19937& random) {
    const float z = 2 * uniform(random) - 1, angle = 6.2831853f * uniform(random), r = std::sqrt(1 - z * z);
    return Eigen::Vector3f(r * std::cos(angle), r * std::sin(angle), z);
  };
  const auto sphere = [&](std::mt19937& random) { return Eigen::Vector3f(0.85f * direction(random)); };
  const auto fish = [](std::mt19937& random) {  // swims along x
    const float t = uniform(random), angle = 6.2831853f * uniform(random);
    const float r = 0.25f * std::sqrt(std::max(0.0f, std::sin(3.7f * t))) + 0.02f;
    return Eigen::Vector3f(1.7f * t, 0.4f * r * std::cos(angle), 0.5f + r * std::sin(angle));
  };
  const std::string good = read_file(kScans + "/a/scan.ply"), bag = read_file(kScans + "/a/scan.bag");
  const auto scan = [&](const std::string& name, const std::string& text) {
    return "--garment B1 --scan " + write(name, text);
  };
  expect_refused(scan("empty.ply", ply_of(0, nan)), "empty_cloud");
  expect_refused(scan("nan.ply", ply_of(50000, nan)), "non_finite");
  expect_refused(scan("few.ply", ply_of(50, box)), "too_few_points");
  expect_refused(scan("fields.ply", ply_of(50000, box, "abc")), "wrong_fields");
  expect_refused(scan("box.ply", ply_of(100000, box)), "not_a_body");
  expect_refused(scan("sphere.ply", ply_of(100000, sphere)), "not_a_body");
  expect_refused(scan("fish.ply", ply_of(100000, fish)), "not_a_body");
  expect_refused(scan("cut.ply", good.substr(0, good.size() / 2)), "broken_file");
  expect_refused(scan("cut.bag", bag.substr(0, bag.size() / 2)), "broken_file");
  expect_refused(scan("words.ply", "no scan at all"), "broken_file");
  expect_refused("--garment B1 --scan " + file("not_there.ply"), "broken_file");

  const std::size_t start = good.find("end_header\n") + 11;
  std::string millimetres = good;
  for (std::size_t i = start; i + 4 <= millimetres.size(); i += 4) {
    float value;
    std::memcpy(&value, &millimetres[i], 4);
    value *= 1000;
    std::memcpy(&millimetres[i], &value, 4);
  }
  EXPECT_EQ(fit(scan("millimetres.ply", millimetres)), 0) << read_file(file("log"));
  EXPECT_EQ(report()["scan"]["unit"], "mm");
  expect_refused(scan("millimetres.ply", millimetres) + " --unit inch", "wrong_unit");
}

// The same body from every format, in its usual unit and axes.
TEST_F(FitProgram, ReadsMeshesOfEveryFormatAlike) {
  namespace formats = tensegric_fit::mesh_files;
  const auto body = tensegric_fit::geometry::read_ply_mesh(kScans + "/a/body.ply");
  auto centimetres = body;  // z up
  for (auto& p : centimetres.vertices) p = Eigen::Vector3d(p.z(), p.x(), p.y()) / 10;
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply"), 0) << read_file(file("log"));
  const json truth = report();
  EXPECT_EQ(truth["scan"]["unit"], "m");
  EXPECT_EQ(truth["scan"]["axes"]["up"], "z");
  for (const auto& [name, bytes, unit, up] : {std::tuple("a.obj", formats::obj_text(body, "body"), "mm", "y"),
                                              {"a.stl", formats::stl_bytes(centimetres), "cm", "z"},
                                              {"a.glb", formats::glb_bytes({{"body", body}}), "m", "y"}}) {
    ASSERT_EQ(fit("--mesh " + write(name, bytes)), 0) << name << read_file(file("log"));
    const json said = report();
    EXPECT_EQ(said["scan"]["unit"], unit) << name;
    EXPECT_EQ(said["scan"]["axes"]["up"], up) << name;
    for (const char* kind : {"heights", "girths"})
      for (const auto& [measure, value] : truth[kind].items())
        EXPECT_NEAR(said[kind][measure].get<double>(), value.get<double>(), 1e-4) << name << ' ' << measure;
  }
  expect_refused("--mesh " + file("a.obj") + " --unit inch", "not_a_body");
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
  EXPECT_NE(read_file(file("out/measures.vit")).find("<m name=\"bust_circ\""), std::string::npos);
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply"), 0);  // old ones are never taken for new ones
  EXPECT_FALSE(fs::exists(folder_ / "out" / "fit.glb"));
}

TEST_F(FitProgram, RefusesBadGarmentsByName) {
  const std::string body = "--mesh " + kScans + "/a/body.ply";
  expect_refused(body + " --garment B1 --ratio waist=0.9", "unknown_line");
  expect_refused(body + " --garment B99", "bad_garment");
  expect_refused(body + " --garment " + write("key.yaml", "name: X\nregion: bust\nlines: []\ncolour: red\n"),
                 "bad_garment");
  expect_refused(body + " --garment " +
                     write("node.yaml",
                           "name: X\nregion: bust\nlines:\n  - {name: l, ratio: 0.9, through: "
                           "[axilla_L, elbow]}\n"),
                 "unknown_line");
  expect_refused(body + " --garment " +
                     write("line.yaml", "name: X\nregion: bust\nlines:\n  - {name: belt, ratio: 0.9}\n"),
                 "unknown_line");
  expect_refused(body + " --garment " +
                     write("region.yaml", "name: X\nregion: hat\nlines:\n  - {name: chest, ratio: 0.9}\n"),
                 "bad_garment");
}

TEST_F(FitProgram, ARefusalLeavesNoOlderResults) {
  ASSERT_EQ(fit("--mesh " + kScans + "/a/body.ply --garment B1"), 0) << read_file(file("log"));
  expect_refused("--garment B1 --scan " + write("words.ply", "no scan at all"), "broken_file");
}

}  // namespace
