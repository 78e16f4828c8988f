/// The harness itself: a case is read to the letter, a difference is seen, a golden value is replaced on
/// purpose only.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "geometry/status.hpp"
#include "golden.hpp"
#include "golden_shape.hpp"
#include "report.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

const std::string kGood = R"(about: A body.
booth: {seed: 3, points: 20000}
scene: bust
garments: [B1]
metrics:
  girth/bust: {golden: 0.9, tolerance: 0.001, reason: "recorded, \"twice\""}  # a word
  girth/hip: {expected: 1, tolerance: 0.01, reason: asked}
  fit/status: {golden: converged, reason: recorded}
)";

class HarnessTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Case read(const std::string& text) const {
    std::ofstream(file_) << text;
    return load_case(file_);
  }
  std::string refusal_of(const std::string& text) const {
    try {
      read(text);
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(std::string(refusal.what()).find(file_), 0u) << refusal.what();
      return std::string(refusal.what()).substr(file_.size());
    }
    return "accepted";
  }
  static std::string with(const std::string& what, const std::string& in_place_of) {
    std::string text = kGood;
    return text.replace(text.find(in_place_of), in_place_of.size(), what);
  }
  static Metrics metrics(double bust) {
    return {
        {"girth/bust", bust}, {"error/girth/bust", 0.002}, {"girth/hip", 1.005}, {"fit/status", "capped"}};
  }

  const fs::path folder_ = fs::temp_directory_path() / ("harness_test." + std::to_string(getpid()));
  const std::string file_ = folder_ / "one.yaml";
};

TEST_F(HarnessTest, ACaseIsReadToTheLetter) {
  const Case asked = read(kGood);
  EXPECT_EQ(asked.name, "one");
  EXPECT_EQ(asked.booth.scanner.seed, 3u);
  EXPECT_EQ(asked.booth.scanner.points, 20000);
  ASSERT_EQ(asked.garments.size(), 1u);
  EXPECT_EQ(asked.garments[0].name, "B1");
  EXPECT_EQ(asked.pipeline["control_mesh"]["template"].as<std::string>(), "bust");
  ASSERT_EQ(asked.expectations.size(), 3u);
  EXPECT_TRUE(asked.expectations[0].golden);
  EXPECT_FALSE(asked.expectations[1].golden);
  EXPECT_EQ(std::get<std::string>(*asked.expectations[2].value), "converged");
}

TEST_F(HarnessTest, WhatACaseFileMayNotSayIsNamed) {
  EXPECT_EQ(refusal_of(with("abuot:", "about:")), ": unknown key 'abuot'");
  EXPECT_EQ(refusal_of(with("sead: 3", "seed: 3")), ": booth: unknown key 'sead'");
  EXPECT_EQ(refusal_of(with("seed: x", "seed: 3")), ": booth: the value of 'seed' has the wrong type");
  EXPECT_EQ(refusal_of(with("sensors: true, unit: 2", "seed: 3")),
            ": booth: 'sensors' goes with neither 'crop_above' nor 'unit'");
  EXPECT_EQ(refusal_of(with("scene: chest", "scene: bust")),
            ": scene 'chest' is not measure, bust, hips or bust+hips");
  EXPECT_EQ(refusal_of(with("scene: measure", "scene: bust")), ": a scene has garments, but for 'measure'");
  EXPECT_EQ(refusal_of(with("tolerence: 0.01", "tolerance: 0.01")), ": girth/hip: unknown key 'tolerence'");
  EXPECT_EQ(refusal_of(with("tolerance: -1", "tolerance: 0.01")), ": girth/hip: 'tolerance' is negative");
  EXPECT_EQ(refusal_of(with("tolerance: .inf", "tolerance: 0.01")), ": girth/hip: 'tolerance' is not finite");
  EXPECT_EQ(refusal_of(with("customer: 7, seed: 3", "seed: 3")),
            ": booth: beside 'customer': unknown key 'seed'");
  EXPECT_EQ(refusal_of(with("customer: -1", "seed: 3")),
            ": booth: 'customer' is -1, outside [0.000000, 2147483647.000000]");
  EXPECT_EQ(refusal_of(with("unit: 0", "seed: 3")), ": booth: 'unit' is 0, outside [0.000001, 1000.000000]");
  EXPECT_EQ(refusal_of(with("", ", reason: asked")), ": girth/hip: key 'reason' is missing");
  EXPECT_EQ(refusal_of(with("expected: 1, golden: 1", "expected: 1")),
            ": girth/hip: needs either 'expected' or 'golden'");
  EXPECT_EQ(refusal_of(with("girth/bust: {expected", "girth/hip: {expected")),
            ": 'girth/bust' is given twice");
  EXPECT_EQ(refusal_of(with("bag: nope.bag", "booth: {seed: 3, points: 20000}")),
            ": there is no bag " + (folder_ / "nope.bag").string());
  EXPECT_EQ(refusal_of(with("pipeline: {tfdd: {}}\nscene", "scene")), ": pipeline: unknown key 'tfdd'");
}

TEST_F(HarnessTest, NumbersHoldWithinTheirToleranceWordsWhereTheyAreTheSame) {
  const Verdict verdict = judge(read(kGood), "bag", metrics(0.9009));
  ASSERT_EQ(verdict.rows.size(), 3u);
  EXPECT_TRUE(verdict.rows[0].holds);
  EXPECT_NEAR(*verdict.rows[0].difference(), 0.0009, 1e-12);  // rounding
  EXPECT_EQ(verdict.rows[0].error, 0.002);
  EXPECT_TRUE(verdict.rows[1].holds);
  EXPECT_FALSE(verdict.rows[1].error);
  EXPECT_FALSE(verdict.rows[2].holds);
  EXPECT_EQ(verdict.failures(), 1);
  EXPECT_FALSE(judge(read(kGood), "bag", metrics(0.8989)).rows[0].holds);
  EXPECT_EQ(judge(read(kGood), "bag", {}).failures(), 3);  // no message is a failure
  Metrics refused = metrics(0.9009);
  refused["refusal"] = std::string("unknown_line");
  EXPECT_FALSE(judge(read(kGood), "bag", refused).faults.empty()) << "the case expects no refusal";
  refused["refusal"] = std::string("none");
  EXPECT_TRUE(judge(read(kGood), "bag", refused).faults.empty());
}

TEST_F(HarnessTest, WhatCannotBeginIsAFaultOfItsCase) {
  Case asked = read(kGood);
  asked.bag = folder_ / "nope.bag";
  HarnessOptions options;
  options.replay = false;
  options.folder = folder_ / "out";
  const Outcome outcome = run_case(asked, options);
  EXPECT_FALSE(outcome.holds());
  EXPECT_FALSE(outcome.verdicts.at(0).faults.empty());
}

TEST_F(HarnessTest, OnlyGoldenValuesAreReplacedAndTheReasonIsKept) {
  const auto text = [this] {
    std::ifstream in(file_);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  Case asked = read(kGood);
  Verdict verdict = judge(asked, "bag", metrics(0.95));
  EXPECT_NE(update_table(asked, verdict).find("+0.05"), std::string::npos);
  update_goldens(asked, verdict, "the neck's landmarks moved");
  std::string wanted = with("golden: 0.95,", "golden: 0.9,");
  wanted.replace(wanted.find("converged"), 9, "capped");
  EXPECT_EQ(text().rfind(wanted + "updates:\n  - date: ", 0), 0u) << text();

  asked = load_case(file_);
  ASSERT_EQ(asked.updates.size(), 1u);
  EXPECT_EQ(asked.updates[0].reason, "the neck's landmarks moved");
  EXPECT_EQ(asked.updates[0].date.size(), std::string("2000-01-01").size());
  EXPECT_EQ(asked.updates[0].commit, "unknown") << "the file lies in no repository";
  EXPECT_EQ(asked.updates[0].values.at("girth/bust"),
            std::make_pair(std::string("0.9"), std::string("0.95")));
  EXPECT_EQ(asked.updates[0].values.at("fit/status").second, "capped");
  EXPECT_EQ(asked.updates[0].values.size(), 2u);
  verdict = judge(asked, "bag", metrics(0.95));
  EXPECT_TRUE(verdict.holds());
  update_goldens(asked, verdict, "nothing new");
  EXPECT_EQ(load_case(file_).updates.size(), 1u);
  update_goldens(asked, verdict, "another shape", true);
  EXPECT_EQ(load_case(file_).updates.size(), 2u);
  EXPECT_THROW(update_goldens(asked, judge(asked, "bag", {}), "nothing came"), geometry::Refusal);
}

TEST_F(HarnessTest, AGoldenValueNeedNotBeTheFirstKey) {
  const Case asked = read(with("{tolerance: 0.001, golden: 0.9,", "{golden: 0.9, tolerance: 0.001,"));
  update_goldens(asked, judge(asked, "bag", metrics(0.95)), "another bust");
  EXPECT_EQ(load_case(file_).updates.at(0).values.at("girth/bust").second, "0.95");
}

TEST_F(HarnessTest, UpdatesNeedNotBeTheLastKey) {
  for (const char* before : {"updates:\n  - first\n\n# Why.\n", "updates:  # why\n- first\n\n"}) {
    Case asked = read(with(std::string(before) + "metrics:", "metrics:"));
    update_goldens(asked, judge(asked, "bag", metrics(0.95)), "it moved");
    asked = load_case(file_);
    ASSERT_EQ(asked.updates.size(), 2u);
    EXPECT_EQ(asked.updates[1].reason, "it moved");
    EXPECT_EQ(asked.updates[1].values.size(), 2u);
  }
  const std::string unread = with("updates: [first]\nmetrics:", "metrics:");
  const Case asked = read(unread);
  EXPECT_THROW(update_goldens(asked, judge(asked, "bag", metrics(0.95)), "it moved"), geometry::Refusal);
  std::ifstream in(file_);
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(in), {}}), unread);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(HarnessTest, NothingIsRecordedFromABadRun) {
  const Case asked = read(kGood);
  Metrics found = metrics(0.95);
  EXPECT_EQ(update_table(asked, judge(asked, "bag", found)).find("girth/hip"), std::string::npos);
  found["girth/hip"] = 2.0;
  Verdict verdict = judge(asked, "bag", found);
  EXPECT_TRUE(against_update(asked, {}, verdict).empty());
  EXPECT_NE(update_table(asked, verdict).find("girth/hip"), std::string::npos)
      << "it fails, and is asked for";
  verdict.faults = {"repeat 2: body/mesh: other bits"};
  EXPECT_EQ(against_update(asked, {}, verdict), verdict.faults);
  EXPECT_EQ(against_update(asked, {}, judge(asked, "bag", {})).size(), 2u) << "two golden values";
  const Case shaped =
      read(with("metrics:\n  shape/centre: {expected: 0, tolerance: 0.001, reason: asked}", "metrics:"));
  EXPECT_EQ(against_update(shaped, {}, judge(shaped, "bag", found)).size(), 1u) << "no body";
  found["girth/bust"] = std::nan("");
  EXPECT_EQ(against_update(asked, {}, judge(asked, "bag", found)).size(), 1u) << "a value that is not finite";
  found = metrics(0.95);
  found["shape/centre"] = HUGE_VAL;
  EXPECT_EQ(against_update(shaped, {}, judge(shaped, "bag", found)).size(), 2u) << "no body, nor finite";
  const auto body = boost::make_shared<TriangleMesh>();
  body->vertices = {0, 0, std::nanf("")};
  Recording recording;
  recording.body = body;
  EXPECT_EQ(against_update(shaped, recording, judge(shaped, "bag", metrics(0.95))).size(), 1u) << "its skin";
}

TEST_F(HarnessTest, ARecordedShapeIsComparedByPartsOfTheBody) {
  const Case asked =
      read(with("metrics:\n  shape/centre: {expected: 0, tolerance: 0.001, reason: asked}", "metrics:"));
  const auto body = boost::make_shared<TriangleMesh>();  // a square and a triangle
  body->vertices = {0, 0, 1.25, 1, 0, 1.25, 1, 1, 1.25, 0, 1, 1.25, 2, 0, 1, 3, 0, 1, 2, 1, 1};
  body->triangles = {0, 1, 2, 0, 2, 3, 4, 5, 6};
  const auto model = boost::make_shared<BodyModel>();
  model->parts = {"trunk", "head"};
  model->mesh_parts = {0, 0, 0, 0, 1, 1, 255};
  Recording recording;
  recording.body = body;
  recording.model = model;
  const auto metric = [&](const std::string& name) {
    return std::get<double>(shape_metrics(asked, recording).at("shape/" + name));
  };
  EXPECT_TRUE(shape_metrics(asked, recording).empty()) << "nothing was recorded so far";
  EXPECT_TRUE(has_moved(asked, recording)) << "from nowhere";
  write_shape(asked, recording);
  EXPECT_FALSE(has_moved(asked, recording));
  const YAML::Node trunk = YAML::LoadFile(folder_ / "shapes" / "one.yaml")["parts"]["trunk"];
  EXPECT_DOUBLE_EQ(trunk["area"].as<double>(), 1);
  EXPECT_DOUBLE_EQ(trunk["centre"][0].as<double>(), 0.5);
  EXPECT_NEAR(trunk["spread"][1].as<double>(), std::sqrt(1. / 12), 1e-6);  // digits written
  for (const char* name : {"centre", "spread", "area"}) EXPECT_LE(metric(name), 1e-6) << name;
  EXPECT_EQ(std::get<std::string>(shape_metrics(asked, recording).at("shape/bits")), "same");

  for (const std::size_t z : {2, 5, 8, 11}) body->vertices[z] += 0.002f;  // the trunk alone
  EXPECT_NEAR(metric("centre"), 0.002, 1e-6);
  EXPECT_LE(metric("spread"), 1e-6);
  EXPECT_EQ(std::get<std::string>(shape_metrics(asked, recording).at("shape/bits")), "other");
  for (const std::size_t x : {3, 6}) body->vertices[x] *= 1.01f;  // wider
  EXPECT_NEAR(metric("area"), 0.01, 1e-6);
  EXPECT_NEAR(metric("spread"), 0.01 * std::sqrt(1. / 12), 1e-5);
  model->mesh_parts[4] = model->mesh_parts[5] = 0;  // no head any more
  EXPECT_TRUE(std::isinf(metric("centre")));
  std::ofstream(folder_ / "shapes" / "one.yaml")
      << "hash: x\nparts: {trunk: {area: .nan, centre: [0, 0, .nan], spread: [.nan, 0, 0]}}\n";
  for (const char* name : {"centre", "spread", "area"}) EXPECT_TRUE(std::isinf(metric(name))) << name;
  std::ofstream(folder_ / "shapes" / "one.yaml") << "hash: x\nparts: {trunk: {area: 1, centre: [0, 0]}}\n";
  EXPECT_THROW(shape_metrics(asked, recording), geometry::Refusal);
}

TEST_F(HarnessTest, PayloadsAreComparedByTopic) {
  EXPECT_TRUE(differences({{"a", "1"}, {"b", "2"}}, {{"a", "1"}, {"b", "2"}}).empty());
  EXPECT_EQ(differences({{"a", "1"}, {"b", "2"}}, {{"a", "1"}, {"b", "3"}}),
            std::vector<std::string>{"b: other bits"});
  EXPECT_EQ(differences({{"a", "1"}}, {}), std::vector<std::string>{"a: nothing came in one of the runs"});

  Recording one, other;
  const auto mesh = boost::make_shared<TriangleMesh>();
  mesh->vertices = {1, 2, 3};
  one.body = boost::make_shared<TriangleMesh>(*mesh);
  mesh->header.seq = 7;  // the transport's
  other.body = boost::make_shared<TriangleMesh>(*mesh);
  EXPECT_TRUE(differences(hashes_of(one), hashes_of(other)).empty());
  mesh->vertices[0] += 1e-7f;
  other.body = mesh;
  EXPECT_EQ(differences(hashes_of(one), hashes_of(other)).size(), 1u);
}

TEST_F(HarnessTest, ForcesAndWarningsAreKeptAndCompared) {
  const auto fit = boost::make_shared<FitState>();
  const auto forces = boost::make_shared<LineForces>();
  const auto warnings = boost::make_shared<FitWarnings>();
  fit->scan_id = forces->scan_id = warnings->scan_id = "s";
  fit->status = FitState::CONVERGED;
  forces->newtons = {12};
  warnings->warnings.resize(1);
  Recording written;
  written.fits = {fit};
  written.forces = {forces};
  written.warnings = {warnings};
  const std::string bag = folder_ / "result.bag";
  rosbag::Bag(bag, rosbag::bagmode::Write).write("/x", ros::Time(1, 0), std_msgs::Header());
  append(written, bag);
  Recording found = recording_in(bag, "s");
  EXPECT_TRUE(differences(hashes_of(written), hashes_of(found)).empty());
  found.forces = {boost::make_shared<LineForces>()};
  found.warnings = {};
  EXPECT_EQ(differences(hashes_of(written), hashes_of(found)),
            (std::vector<std::string>{"body/warnings: nothing came in one of the runs",
                                      "control/forces: other bits"}));
}

TEST_F(HarnessTest, ReportsAreWholeAndSafe) {
  Outcome outcome;
  outcome.asked = read(with("about: A <body> & more.", "about: A body."));
  outcome.verdicts = {judge(outcome.asked, "bag", metrics(0.9))};
  outcome.verdicts[0].faults = {"a \"fault\" < 1"};
  const std::string xml = junit_xml({outcome}), page = html_page({outcome}), lines = json_lines({outcome});
  EXPECT_NE(xml.find("tests=\"1\" failures=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("a &quot;fault&quot; &lt; 1"), std::string::npos);
  EXPECT_NE(xml.find("fit/status: capped, expected converged"), std::string::npos);
  EXPECT_NE(page.find("1 of 1 cases fail"), std::string::npos);
  EXPECT_NE(page.find("A &lt;body&gt; &amp; more."), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "needs a network";
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 4);  // a line a metric
}

}  // namespace
}  // namespace tensegric_fit::regression
