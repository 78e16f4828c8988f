/// The export of a fit, without a master.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <tensegric_fit/GarmentLine.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "fit/fitted_folder.hpp"
#include "geometry/ply.hpp"
#include "geometry/status.hpp"
#include "mesh_files/read_mesh.hpp"
#include "ros/body_messages.hpp"
#include "ros/export_fit.hpp"
#include "ros/export_folders.hpp"
#include "ros/sealed.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const ExportOptions kWhole{true};
constexpr double kPi = 3.14159265358979323846;

/// A trunk: a tube of 0.15 m, open above and below.
geometry::TriangleMesh tube() {
  constexpr int kAround = 60, kLevels = 21;
  geometry::TriangleMesh mesh;
  for (int level = 0; level < kLevels; ++level) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * kPi * i / kAround;
      mesh.vertices.emplace_back(0.15 * std::cos(angle), 0.15 * std::sin(angle), 1 + 0.02 * level);
      if (level == 0) continue;
      const int here = level * kAround + i, next = level * kAround + (i + 1) % kAround;
      mesh.triangles.emplace_back(here - kAround, next - kAround, next);
      mesh.triangles.emplace_back(here - kAround, next, here);
    }
  }
  return mesh;
}

geometry::GirthLoop loop_at(const std::string& name, double height) {
  geometry::GirthLoop loop{name, {}};
  for (int i = 0; i < 60; ++i)
    loop.points.emplace_back(0.15 * std::cos(2 * kPi * i / 60), 0.15 * std::sin(2 * kPi * i / 60), height);
  return loop;
}

class ExportFitTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    scan_ = fitted("1.000000000-00000001");
  }
  void TearDown() override { fs::remove_all(root_); }

  /// The whole trunk at nine tenths of its width.
  static FittedScan fitted(const std::string& scan_id) {
    const ScanTag tag{std_msgs::Header(), scan_id};
    const geometry::TriangleMesh mesh = tube();
    geometry::ControlMesh control;
    control.outer = {{0.15, 0, 1.1}, {0, 0.15, 1.1}, {0.1, 0.1, 1.3}};
    control.inner = {{0.1, 0, 1.1}, {0, 0.1, 1.1}, {0.07, 0.07, 1.3}};
    control.triangles = {{0, 1, 2}};
    control.outer_fixed = control.inner_fixed = {1, 1, 0};
    control.names = {"", "", ""};
    control.regions = {{"bust", {0}}};
    geometry::BodyMeasures measures;
    measures.landmarks = {{"bust_point_L", {0.15, 0, 1.2}, 0.9, ""},
                          {"navel", {0.1, 0.2, 0.3}, 0.4, "by proportion"}};
    measures.girths = {{"bust", 0.942, 0.9, "", 0.004}, {"underbust", 0.75, 0.4, "hair, <b>long</b>"}};
    measures.heights = {{"bust", 1.2, 0.9, ""}, {"stature", 1.7, 1, ""}};
    measures.loops = {loop_at("bust", 1.21)};
    measures.loops.push_back(loop_at("neck", 1.329));
    measures.missing = {{"neck", "no head"}};

    const auto fit = boost::make_shared<FitState>();
    fit->garment = "B1\xff";  // no UTF-8: anyone may publish a garment
    fit->solver = "equilibrium";
    fit->status = FitState::CONVERGED;
    fit->outer = flat(0.9, control.outer);
    fit->lines.resize(1);
    LineResult& line = fit->lines[0];
    line.name = "chest";
    line.nodes = {0, 2, 1};
    line.initial = 0.4;
    line.neutral = line.final = 0.36;
    line.request = line.ratio = 0.9;
    line.law = GarmentLine::RIGID;
    fit->regions.resize(1);
    fit->regions[0].name = "bust";
    fit->regions[0].volume_before = fit->regions[0].volume_after = 0.001;
    const auto deformed = boost::make_shared<DeformedMesh>();
    for (const double value : flat(0.9, mesh.vertices))
      deformed->vertices.push_back(static_cast<float>(value));
    deformed->distortion.assign(mesh.vertices.size(), 0.9F);
    return {boost::make_shared<TriangleMesh>(to_message(tag, mesh, {})),
            boost::make_shared<Landmarks>(to_message(tag, measures)),
            boost::make_shared<ControlMesh>(to_message(tag, control)), fit, deformed};
  }

  static std::vector<double> flat(double width, const std::vector<Eigen::Vector3d>& points) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : points)
      for (const double value : {width * p.x(), width * p.y(), p.z()}) values.push_back(value);
    return values;
  }

  static std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Whether a validator that is not ours accepts it.
  static bool is_valid(const fs::path& document) {
    const std::string schema = TENSEGRIC_FIT_SOURCE_DIR "/launch/schemas/fit.schema.json";
    return std::system(
               ("/usr/bin/python3 -m jsonschema -i '" + document.string() + "' '" + schema + "' 2>/dev/null")
                   .c_str()) == 0;
  }

  std::string refused(const FittedScan& scan, const std::string& directory) const {
    try {
      export_fit(scan, directory, kWhole);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  }

  std::string not_deleted(const std::string& directory, const std::string& scan_id) const {
    try {
      delete_exports(directory, scan_id);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  }

  const fs::path root_ = fs::temp_directory_path() / "tensegric_fit_export_test";
  FittedScan scan_;
};

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
  EXPECT_EQ(export_fit(scan_, folder, kWhole).size(), 15u);
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
  EXPECT_EQ(fit["body"]["bra_size"]["before"], "75D");
  EXPECT_TRUE(fit["body"]["bra_size"]["after"].is_null());
  EXPECT_NEAR(fit["body"]["landmarks"][0]["after_mm"][0], 135, 1e-3);
  EXPECT_EQ(fit["files"].size(), 15u);
  for (const std::string name : fit["files"]) EXPECT_GT(fs::file_size(folder / name), 0u) << name;
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

TEST_F(ExportFitTest, ThePageNeedsNothingElseAndTakesNamesAsTheyAre) {
  export_fit(scan_, root_ / "one", kWhole);
  const std::string page = text_of(root_ / "one" / "fit.html");
  EXPECT_NE(page.find("<td>bust girth, cm</td><td>94.2</td><td>84.8</td><td>-9.4</td>"), std::string::npos);
  EXPECT_NE(page.find("<td>lift of the bust, mm</td><td></td><td></td><td>+0</td>"), std::string::npos);
  EXPECT_NE(page.find("<td>chest</td><td>40.0</td><td>36.0</td><td>10.0 %</td>"), std::string::npos);
  EXPECT_NE(page.find("<button data-loop=\"bust\""), std::string::npos);
  EXPECT_EQ(page.find("data-loop=\"underbust\""), std::string::npos) << "its tape is not known";
  EXPECT_NE(page.find("<b>75D</b>"), std::string::npos);
  EXPECT_NE(page.find("hair, &lt;b&gt;long&lt;/b&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos);
  EXPECT_EQ(page.find("<link"), std::string::npos);
  const std::string html = page.substr(0, page.find("<script"));
  std::size_t pictures = 0;
  for (std::size_t at = html.find("src="); at != std::string::npos;
       at = html.find("src=", at + 1), ++pictures)
    EXPECT_EQ(html.compare(at, 27, "src=\"data:image/png;base64,"), 0);
  EXPECT_EQ(pictures, 3u);
  EXPECT_EQ(html.find("href="), std::string::npos);
  EXPECT_LT(page.size(), 8'000'000u);
  EXPECT_EQ(text_of(root_ / "one" / "measurements.csv"),
            "kind,name,before_mm,after_mm,confidence,half_width_mm,reason\r\n"
            "height,bust,1200.0,1200.0,0.90,,\r\n"
            "height,stature,1700.0,1700.0,1.00,,\r\n"
            "girth,bust,942.0,847.8,0.90,4.0,\r\n"
            "girth,underbust,750.0,,0.40,,\"hair, <b>long</b>\"\r\n");
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
  EXPECT_EQ(export_fit(scan_, root_ / "one", kWhole).size(), 15u);
}

TEST_F(ExportFitTest, AnEncryptedExportIsReadWithItsKeyAlone) {
  if (std::system("command -v age-keygen > /dev/null") != 0) GTEST_SKIP() << "age is not installed";
  fs::create_directories(root_);
  const std::string key = (root_ / "key").string(), out = (root_ / "out").string();
  ASSERT_EQ(
      std::system(
          ("age-keygen -o " + key + " 2> /dev/null && age-keygen -y " + key + " > " + key + ".pub").c_str()),
      0);
  std::string recipient = text_of(key + ".pub");
  recipient.pop_back();  // end of the line
  EXPECT_NO_THROW(check_recipient(recipient));
  for (const std::string& bad : {std::string("age1short"), "-o/etc/passwd" + recipient, recipient + "\n"})
    EXPECT_THROW(check_recipient(bad), geometry::Refusal) << bad;

  const fs::path folder = root_ / "exports" / "one";
  EXPECT_EQ(export_fit(scan_, folder, {true, recipient}).size(), 2u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2) << "nothing else";
  EXPECT_EQ(json::parse(text_of(folder / "sealed.json")).size(), 3u);
  fs::create_directories(out);
  ASSERT_EQ(
      std::system(
          ("age -d -i " + key + " " + (folder / "fit.tar.age").string() + " | tar -x -C " + out).c_str()),
      0);
  export_fit(scan_, root_ / "plain", kWhole);
  for (const auto& entry : fs::directory_iterator(root_ / "plain"))
    EXPECT_EQ(text_of(entry.path()), text_of(fs::path(out) / entry.path().filename())) << entry.path();
  EXPECT_EQ(delete_exports(root_ / "exports", scan_.body->scan_id), std::vector<std::string>{folder});
}

TEST_F(ExportFitTest, OldExportsGoAndNothingElse) {
  for (const char* name : {"old", "new", "spoilt"}) export_fit(scan_, root_ / name, kWhole);
  std::ofstream(root_ / "spoilt" / "precious") << "mine";
  fs::create_directories(root_ / "no_export");
  fs::create_directory_symlink(root_ / "new", root_ / "link");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24 * 31);
  for (const char* name : {"old", "spoilt"}) fs::last_write_time(root_ / name / "fit.json", long_ago);
  std::vector<std::string> left;
  EXPECT_TRUE(delete_old_exports(root_, 32, left).empty());
  EXPECT_TRUE(left.empty());
  EXPECT_EQ(delete_old_exports(root_, 30, left), std::vector<std::string>{root_ / "old"});
  EXPECT_EQ(left.size(), 1u) << "the spoilt one";
  for (const char* name : {"new", "spoilt", "no_export"}) EXPECT_TRUE(fs::exists(root_ / name)) << name;
  left.clear();
  EXPECT_TRUE(delete_old_exports(root_ / "nowhere", 30, left).empty());
  EXPECT_EQ(left.size(), 1u);
}

TEST_F(ExportFitTest, AFolderMadeToHarmIsLeftAlone) {
  const std::string id = scan_.body->scan_id;
  export_fit(scan_, root_ / "one", kWhole);
  fs::rename(root_ / "one" / "fit.json", root_ / "aside.json");
  const auto is_left_alone = [&] {
    return not_deleted(root_, id) == "nothing_yet" && fs::exists(root_ / "one");
  };
  fs::create_symlink(root_ / "aside.json", root_ / "one" / "fit.json");
  EXPECT_TRUE(is_left_alone()) << "a document that is a link";
  fs::remove(root_ / "one" / "fit.json");
  ASSERT_EQ(mkfifo((root_ / "one" / "fit.json").c_str(), 0600), 0);
  EXPECT_TRUE(is_left_alone()) << "a pipe that nobody writes to";
  fs::remove(root_ / "one" / "fit.json");
  std::ofstream(root_ / "one" / "fit.json") << std::string(1 << 20, '[');
  EXPECT_TRUE(is_left_alone()) << "a document that is nested too deeply";
  fs::resize_file(root_ / "one" / "fit.json", std::uintmax_t{1} << 40);
  EXPECT_TRUE(is_left_alone()) << "a document of a terabyte";
  fs::rename(root_ / "aside.json", root_ / "one" / "fit.json");
  fs::remove(root_ / "one" / "body.ply");
  fs::create_symlink("/etc/passwd", root_ / "one" / "body.ply");
  EXPECT_EQ(not_deleted(root_, id), "bad_option") << "a link in place of a file of ours";
  EXPECT_TRUE(fs::exists(root_ / "one"));
}

/// A picture of the page as headless Chromium shows it, opened at that address.
cv::Mat shown(const fs::path& page, const std::string& address) {
  const fs::path picture = page.parent_path() / "shown.png", profile = page.parent_path() / "profile";
  fs::remove(picture);
  const std::string command =
      "timeout 120 chromium --headless=new --no-sandbox --use-gl=angle --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --window-size=390,900 --virtual-time-budget=8000 --user-data-dir='" +
      profile.string() + "' --screenshot='" + picture.string() + "' 'file://" + page.string() + "#" +
      address + "' > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return cv::imread(picture.string());
}

/// Share of the pixels that differ clearly.
double difference(const cv::Mat& a, const cv::Mat& b) {
  if (a.empty() || a.size() != b.size()) return -1;
  cv::Mat apart;
  cv::absdiff(a, b, apart);
  int clear = 0;
  for (int y = 0; y < apart.rows; ++y)
    for (int x = 0; x < apart.cols; ++x) {
      const auto& p = apart.at<cv::Vec3b>(y, x);
      clear += std::max({p[0], p[1], p[2]}) > 20;
    }
  return static_cast<double>(clear) / (a.rows * a.cols);
}

TEST_F(ExportFitTest, TheBodyInThePageTurnsAndChanges) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  export_fit(scan_, root_ / "one", kWhole);
  const fs::path page = root_ / "one" / "fit.html";
  const cv::Mat worn = shown(page, "share=100");
  ASSERT_FALSE(worn.empty());
  EXPECT_EQ(difference(worn, shown(page, "share=100")), 0) << "the same picture twice";
  EXPECT_GT(difference(worn, shown(page, "share=0")), 0.02) << "the trunk is wider, its colour another";
  EXPECT_GT(difference(worn, shown(page, "share=100&loop=bust")), 0.001) << "the tape";
  EXPECT_GT(difference(worn, shown(page, "share=100&beside=1")), 0.02);
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

TEST_F(ExportFitTest, ExportsAreDeletedByScanAndNothingElseIs) {
  const std::string id = scan_.body->scan_id;
  for (const char* name : {"one", "two"}) export_fit(scan_, root_ / name, kWhole);
  export_fit(fitted("3.000000000-00000003"), root_ / "other", kWhole);
  fs::create_directories(root_ / "no_export");
  std::ofstream(root_ / "no_export" / "fit.json") << R"({"scan": {"scan_id": ")" << id << "\"}}";
  fs::create_directories(root_ / "elsewhere");
  fs::create_directory_symlink(root_ / "one", root_ / "elsewhere" / "link");

  EXPECT_EQ(not_deleted(root_ / "elsewhere", id), "nothing_yet");  // links are not followed
  EXPECT_EQ(not_deleted("relative", id), "bad_option");
  EXPECT_EQ(not_deleted(root_, ""), "bad_option");
  EXPECT_EQ(not_deleted(root_ / "nowhere", id), "cannot_write");
  EXPECT_EQ(delete_exports(root_.string() + "/", id),
            (std::vector<std::string>{root_ / "one", root_ / "two"}));
  EXPECT_EQ(not_deleted(root_, id), "nothing_yet");
  EXPECT_TRUE(fs::exists(root_ / "other" / "fit.json"));
  EXPECT_TRUE(fs::exists(root_ / "no_export" / "fit.json"));

  std::ofstream(root_ / "other" / "precious") << "mine";
  EXPECT_EQ(not_deleted(root_, "3.000000000-00000003"), "bad_option");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "other"), {}), 16);
  fs::remove(root_ / "other" / "precious");
  EXPECT_EQ(not_deleted(root_ / "other", "3.000000000-00000003"), "");  // the export itself
  EXPECT_FALSE(fs::exists(root_ / "other"));
}

}  // namespace
}  // namespace tensegric_fit::node
