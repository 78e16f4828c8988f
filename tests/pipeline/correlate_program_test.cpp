// The program `correlate` as its users start it, after `fit`.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "geometry/ply.hpp"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kScans = TENSEGRIC_FIT_SCANS;
const char* const kResults[] = {"correlate.json", "correlate.html", "distance.png",
                                "distance.ply",   "distance.csv",   "silhouettes.png"};

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Exit code; -1 where a signal ended it.
int started(const std::string& program, const std::string& arguments, const std::string& log) {
  const int status = std::system(
      (TENSEGRIC_FIT_PROGRAMS "/" + program + " " + arguments + " --quiet > " + log + " 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class CorrelateProgram : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("tensegric_correlate_program_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    ASSERT_EQ(started("fit",
                      "--scan " + kScans +
                          "/a/scan.ply --garment B1 --ratio 0.95 --body-triangles 20000 --out " + file("fit"),
                      file("log")),
              0)
        << read_file(file("log"));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static std::string file(const std::string& name) { return (folder_ / name).string(); }
  static int correlate(const std::string& arguments) {
    return started("correlate", arguments + " --out " + file("out"), file("log"));
  }
  static json report() { return json::parse(read_file(file("out/correlate.json"))); }

  static void expect_refused(const std::string& arguments, const std::string& code) {
    EXPECT_EQ(correlate(arguments), 3) << read_file(file("log"));
    const json said = report();
    EXPECT_EQ(said["status"], "refused");
    EXPECT_EQ(said["reason"]["code"], code) << said["reason"]["message"];
    for (const char* name : kResults)
      EXPECT_EQ(fs::exists(folder_ / "out" / name), std::string(name) == "correlate.json") << name;
  }
  // A copy of the fit that may be spoilt.
  static std::string copied() {
    fs::remove_all(file("spoilt"));
    fs::copy(file("fit"), file("spoilt"));
    return file("spoilt");
  }

  static fs::path folder_;
};

fs::path CorrelateProgram::folder_;

TEST_F(CorrelateProgram, WritesEveryFieldAndFile) {
  ASSERT_EQ(correlate("--fit " + file("fit") + " --worn " + kScans + "/a/scan.bag --body-triangles 20000"), 0)
      << read_file(file("log"));
  for (const char* name : kResults) EXPECT_GT(fs::file_size(folder_ / "out" / name), 0u) << name;
  const json r = report();
  EXPECT_EQ(r["status"], "ok");
  EXPECT_EQ(r["alignment"]["status"], "converged");
  EXPECT_EQ(r["simulated"]["lines"][0]["name"], "chest");
  // The same scan: nothing moved but what was simulated.
  EXPECT_TRUE(r["worn"]["same_scan"].get<bool>());
  EXPECT_NE(read_file(file("log")).find("once more"), std::string::npos);
  EXPECT_LT(r["distance"]["still"]["mean_size"].get<double>(), 1e-4);
  EXPECT_GT(r["distance"]["covered"]["mean_size"].get<double>(), 5e-4);
  for (const char* effect : {"bust_point_height", "bust_point_spread"})
    EXPECT_NEAR(r["effects"][effect]["worn"].get<double>(), r["effects"][effect]["before"].get<double>(),
                0.002)
        << effect;  // m; body.ply is float32, and does not know what is filled
  EXPECT_LT(r["girths"]["bust"]["simulated"], r["girths"]["bust"]["worn"]);
  EXPECT_GT(r["heights"]["stature"]["worn"].get<double>(), 1.6);
  const std::string page = read_file(file("out/correlate.html"));
  EXPECT_EQ(page.find("src=\"data:image/png;base64,") == std::string::npos, false);
  EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos)
      << "the page may ask for another file";
  for (const char* other : {"src=\"http", "href=\"http", "url(http"})
    EXPECT_EQ(page.find(other), std::string::npos) << other << ": the page needs another file";
  const auto coloured = tensegric_fit::geometry::read_ply_mesh(file("out/distance.ply"));
  std::ifstream csv(file("out/distance.csv"));
  std::size_t rows = 0;
  for (std::string row; std::getline(csv, row);) ++rows;
  EXPECT_EQ(rows, coloured.vertices.size() + 1);
}

TEST_F(CorrelateProgram, KnowsTheSameScanMeshedOtherwise) {
  ASSERT_EQ(correlate("--fit " + file("fit") + " --worn " + kScans + "/a/scan.ply --body-triangles 30000"), 0)
      << read_file(file("log"));
  EXPECT_TRUE(report()["worn"]["same_scan"].get<bool>());
  ASSERT_EQ(correlate("--fit " + file("fit") + " --mesh " + file("fit/deformed.ply")), 0)
      << read_file(file("log"));
  EXPECT_FALSE(report()["worn"]["same_scan"].get<bool>());  // what is simulated, and no scan
}

TEST_F(CorrelateProgram, RefusesByName) {
  const std::string twisted = copied();
  json fit = json::parse(read_file(twisted + "/report.json"));
  fit["posture"]["twist"] = 3;
  std::ofstream(twisted + "/report.json") << fit;
  expect_refused("--fit " + twisted + " --worn " + kScans + "/a/scan.ply", "bad_option");
  const std::string good = "--fit " + file("fit");
  expect_refused(good + " --mesh " + kScans + "/b/body.ply", "other_person");
  expect_refused(good + " --worn " + file("not_there.ply"), "broken_file");
  expect_refused("--fit " + file("nowhere") + " --mesh " + kScans + "/a/body.ply", "broken_file");

  const std::string worn = " --mesh " + kScans + "/a/body.ply";
  fs::copy_file(kScans + "/a/body.ply", copied() + "/deformed.ply", fs::copy_options::overwrite_existing);
  expect_refused("--fit " + file("spoilt") + worn, "bad_mesh");
  std::ofstream(copied() + "/report.json") << "{\"status\": \"ok\", \"scan\": {}}";
  expect_refused("--fit " + file("spoilt") + worn, "nothing_yet");
  std::ofstream(copied() + "/report.json") << "no report";
  expect_refused("--fit " + file("spoilt") + worn, "broken_file");
  const std::string pipe = copied() + "/report.json";
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  expect_refused("--fit " + file("spoilt") + worn, "broken_file");

  auto body = tensegric_fit::geometry::read_ply_mesh(kScans + "/a/body.ply");
  for (Eigen::Vector3d& vertex : body.vertices) vertex *= 1e3;
  tensegric_fit::geometry::write_ply_mesh(file("millimetres.ply"), body);
  expect_refused(good + " --mesh " + file("millimetres.ply") + " --unit inch", "wrong_unit");
}

TEST_F(CorrelateProgram, UsageErrorsAreTwo) {
  EXPECT_EQ(correlate(""), 2);
  EXPECT_EQ(correlate("--fit " + file("fit")), 2);
  EXPECT_EQ(correlate("--fit a --worn b.ply --mesh c.ply"), 2);
  EXPECT_EQ(correlate("--fit a --worn b.ply --thickness thin"), 2);
  EXPECT_EQ(correlate("--fit a --worn b.ply --thickness 0.5"), 2);
  EXPECT_EQ(correlate("--fit a --worn b.ply --unit foot"), 2);
  EXPECT_EQ(correlate("--help"), 0);
  fs::create_directories(file("out"));
  fs::copy_file(kScans + "/a/body.ply", file("out/distance.ply"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(correlate("--fit " + file("fit") + " --mesh " + file("out/distance.ply")), 2);
}

}  // namespace
