/// What `fit` takes, and what it refuses.
#include <fcntl.h>
#include <sys/file.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <sstream>
#include <vector>

#include "fit/command_line.hpp"
#include "fit_program.hpp"
#include "geometry/ply.hpp"
#include "mesh_files/maker_files.hpp"

namespace {

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

// As the program parses them; what it makes of the code: exit_codes_test.py, which asks for --help, too.
TEST(FitUsage, ErrorsAreTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--scan", "a.ply", "--nonsense"},
      {"--scan", "a.ply", "--garment", "B1", "--ratio", "tight"},
      {"--scan", "a.ply", "--garment", "B1", "--ratio", "chest=-1"},
      {"--scan", "a.ply", "--garment", "B1", "--solver", "magic"},
      {"--scan", "a.ply", "--garment", "B1", "--band", "loose"},
      {"--scan", "a.ply", "--mesh", "b.ply"},
      {"--scan", "a.ply", "--body-triangles", "3"},
      {"--scan", "a.ply", "--garment", ""},  // an unset variable of a script is not "measure only"
      {"--mesh", "a.ply", "--gravity", "0,0,-1"},
      {"--mesh", "a.ply", "--solver", "adaptive"},  // nor for these to do
      {"--mesh", "a.ply", "--volume", "body"},
      {"--scan", "a.ply", "--control-triangles", "480"},
      {"--mesh", "a.ply", "--fixed", "b.yaml", "--overlay"},  // a shape has no body model
      {"--scan", "a.ply", "--twist", "15"},                   // nothing to show it with
      {"--scan", "a.ply", "--garment", "B1", "--twist", "61"}};
  for (const std::vector<std::string>& arguments : wrong) {
    tensegric_fit::fit::CommandLine line;
    std::ostringstream said;
    const std::optional<int> code = tensegric_fit::fit::parse(arguments, line, said);
    EXPECT_EQ(code.value_or(0), 2) << testing::PrintToString(arguments);
    EXPECT_FALSE(said.str().empty()) << testing::PrintToString(arguments);
  }
  tensegric_fit::fit::CommandLine line;
  std::ostringstream said;
  EXPECT_FALSE(tensegric_fit::fit::parse({"--scan", "a.ply", "--garment", "B1"}, line, said)) << said.str();
}

TEST_F(FitProgram, NeverOverwritesAnInput) {
  fs::create_directories(file("out"));
  fs::copy_file(kScans + "/a/body.ply", file("out/body.ply"));
  const std::string before = read_file(file("out/body.ply"));
  EXPECT_EQ(fit("--mesh " + file("out/../out/body.ply")), 2);
  EXPECT_TRUE(read_file(file("out/body.ply")) == before);
}

TEST_F(FitProgram, NeverReplacesPartsOfAnExport) {
  for (const char* document : {"fit.json", "sealed.json"}) {
    const std::string folder = file(std::string("export_") + document);
    fs::create_directories(folder);
    std::ofstream(folder + "/" + document) << "{}";
    std::ofstream(folder + "/body.ply") << "another customer's";
    EXPECT_EQ(run("fit --mesh " + kScans + "/a/body.ply --out " + folder), 2);
    EXPECT_EQ(read_file(folder + "/body.ply"), "another customer's");
  }
}

TEST_F(FitProgram, OldResultsThatCannotBeRemovedAreNotLeftBesideNewOnes) {
  const std::string folder = file("stuck");
  fs::create_directories(folder + "/report.json/in");
  EXPECT_EQ(run("fit --mesh /nowhere.ply --out " + folder), 1);
}

TEST_F(FitProgram, WhatCorrelateWroteOfTheBodyBeforeIsRemoved) {
  fs::create_directories(file("out"));
  write("out/distance.csv", "of the body before");
  expect_refused("--mesh /nowhere.ply", "broken_file");
  EXPECT_FALSE(fs::exists(file("out/distance.csv")));
}

TEST_F(FitProgram, WhoseScanWasRefusedIsInTheReport) {
  expect_refused("--mesh /nowhere.ply --customer 4711", "broken_file");
  EXPECT_EQ(report()["scan"]["customer"], "4711");
}

TEST_F(FitProgram, AFolderThatAnotherProgramWritesIntoIsLeftAlone) {
  fs::create_directories(file("out"));
  write("out/report.json", "the other's");
  const int folder = open(file("out").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(flock(folder, LOCK_EX), 0);
  EXPECT_EQ(fit("--mesh /nowhere.ply"), 1);
  EXPECT_NE(log().find("another program writes into this folder"), std::string::npos) << log();
  EXPECT_EQ(read_file(file("out/report.json")), "the other's");
  close(folder);
  expect_refused("--mesh /nowhere.ply", "broken_file");
}

TEST_F(FitProgram, BustOnlyIsForBustGarments) {
  expect_refused("--scan " + kScans + "/a/scan.ply --bust-only --garment B1+H2", "bad_option");
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

// The same body in every format, in its usual unit and axes: tests/mesh_files/odd_meshes.py.
TEST_F(FitProgram, AMeshInAnotherUnitThanIsSaidIsRefused) {
  const auto body = tensegric_fit::geometry::read_ply_mesh(kScans + "/a/body.ply");
  const std::string millimetres = write("a.obj", tensegric_fit::mesh_files::obj_text(body, "body"));
  expect_refused("--mesh " + millimetres + " --unit inch", "wrong_unit");
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
