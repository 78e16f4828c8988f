#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "body_score.hpp"
#include "geometry/status.hpp"
#include "totals.hpp"
#include "truth_reader.hpp"

namespace tensegric_fit {
namespace {

using population::Figure;
using population::Score;
using population::Truth;

class PopulationTest : public testing::Test {
 protected:
  PopulationTest() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("population_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~PopulationTest() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::filesystem::path folder_;
};

const Figure& figure(const std::vector<Figure>& figures, const std::string& name) {
  for (const Figure& f : figures)
    if (f.name == name) return f;
  throw std::out_of_range(name);
}

/// A body that was measured, and its truth.
struct Case {
  geometry::BodyMeasures measured;
  Truth truth;
  Case() {
    measured.girths = {{"bust", 0.912, 0.9, "", 0.014}, {"waist", 0.700, 0.4, "unsure", 0.030}};
    measured.heights = {{"bust", 1.195, 0.8, "", 0.002}};
    measured.landmarks = {{"crotch", {0.06, 0.003, 0.804}, 0.7, "", 0.008}};
    truth.measures.girths = {
        {"bust", 0.900, 1, ""}, {"waist", 0.720, 1, ""}, {"neck", 0.310, 1, ""}, {"thigh_L", 0.5, 1, ""}};
    truth.measures.heights = {{"bust", 1.200, 1, ""}};
    truth.measures.landmarks = {{"crotch", {0, 0, 0.8}, 1, ""}};
    truth.doubts.vague = {"girth waist"};
    truth.doubts.loose = {{"crotch", {2, 0, 0}}};
  }
};

TEST_F(PopulationTest, FiguresAreErrorsInMillimetresBesideTheirLimits) {
  const Case body;
  const auto figures = population::figures_of(body.measured, body.truth);
  EXPECT_NEAR(figure(figures, "girth bust").error, 12, 1e-9);
  EXPECT_FALSE(figure(figures, "girth bust").within());
  EXPECT_NEAR(figure(figures, "girth bust").half_width, 14, 1e-9);
  EXPECT_NEAR(figure(figures, "height bust").error, -5, 1e-9);
  EXPECT_FALSE(figure(figures, "girth waist").counts);  // vague
  EXPECT_EQ(figure(figures, "girth waist").cause, "unsure");
  EXPECT_NEAR(figure(figures, "point crotch").error, 5,
              1e-9);  // 60 mm along the loose direction do not count
  EXPECT_FALSE(std::isfinite(figure(figures, "girth neck").error));
  EXPECT_FALSE(figure(figures, "girth neck").within());
  EXPECT_TRUE(figure(figures, "girth neck").counts);
  EXPECT_THROW(figure(figures, "girth thigh_L"),
               std::out_of_range);  // not measured, and nothing that must be
}

TEST_F(PopulationTest, HiddenFiguresAreApartUnlessVague) {
  Case body;
  body.truth.doubts.hidden = {"girth bust", "girth waist"};
  const auto figures = population::figures_of(body.measured, body.truth);
  EXPECT_TRUE(figure(figures, "girth bust").hidden);
  EXPECT_FALSE(figure(figures, "girth bust").counts);
  EXPECT_FALSE(figure(figures, "girth waist").hidden);
}

TEST_F(PopulationTest, TruthFilesOfBothKindsAreRead) {
  const std::string path = write("A_truth.json", R"({"landmarks": {"crotch": [1, 2, 3], "navel": null},
    "heights": {"bust": 1.2}, "girths": {"neck": 0.35, "neck_min": 0.31, "waist": 0.7}, "vague": ["girth neck", "point shoulder_L"],
    "hidden": ["girth underbust"], "loose": {"crotch": [0, 1, 0]}, "extra": {"waist_method": "no interior minimum: ruler level"}})");
  const Truth truth = population::read_truth(path);
  ASSERT_EQ(truth.measures.girths.size(), 3u);
  for (const geometry::Measure& girth : truth.measures.girths)
    EXPECT_EQ(girth.metres, girth.name == "waist" ? 0.7 : 0.31) << girth.name;
  EXPECT_EQ(truth.doubts.vague, std::vector<std::string>{"point shoulder_L"});
  EXPECT_EQ(truth.doubts.hidden, std::vector<std::string>{"girth underbust"});
  EXPECT_EQ(truth.doubts.loose.at(0).second, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(truth.measures.landmark("crotch"), Eigen::Vector3d(1, 2, 3));
  const std::string both =
      write("D_truth.json",
            R"({"landmarks": {}, "heights": {}, "girths": {}, "hidden": ["height crotch", "point axilla_L"],
    "hidden_on_surface": ["height crotch"]})");
  EXPECT_EQ(population::read_truth(both).doubts.hidden.size(), 2u);
  EXPECT_EQ(population::read_truth(both, true).doubts.hidden, std::vector<std::string>{"height crotch"});
  const Truth older =
      population::read_truth(write("B_truth.json", R"({"landmarks": {}, "heights": {}, "girths": {},
    "extra": {"waist_method": "no interior minimum: ruler level"}})"));
  EXPECT_EQ(older.doubts.vague, (std::vector<std::string>{"girth waist", "height waist"}));
  for (const char* text : {"{", "[]", R"({"landmarks": {"crotch": [1, 2]}, "heights": {}, "girths": {}})"}) {
    try {
      population::read_truth(write("C_truth.json", text));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kBrokenFile);
    }
  }
}

TEST_F(PopulationTest, ARunGoesOnWhereItsFileEnds) {
  const Case body;
  const Score one{"model", "scan", "1", "", population::figures_of(body.measured, body.truth)},
      two{"implicit", "surface", "2", "not_a_body: no", {}};
  const std::string path = (folder_ / "scores.jsonl").string();
  EXPECT_TRUE(population::read_scores(path).empty());
  population::append_score(path, one);
  population::append_score(path, two);
  const auto whole = std::filesystem::file_size(path);
  std::ofstream(path, std::ios::app | std::ios::binary) << R"({"family": "mod)";  // the power failed
  const std::vector<Score> read = population::read_scores(path);
  EXPECT_GT(std::filesystem::file_size(path), whole) << "who only reads leaves it to who writes";
  population::take_off_unfinished(path);
  EXPECT_EQ(std::filesystem::file_size(path), whole);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[1].refusal, two.refusal);
  ASSERT_EQ(read[0].figures.size(), one.figures.size());
  for (std::size_t i = 0; i < one.figures.size(); ++i) {
    EXPECT_EQ(read[0].figures[i].name, one.figures[i].name);
    EXPECT_EQ(read[0].figures[i].error, one.figures[i].error);
    EXPECT_EQ(read[0].figures[i].half_width, one.figures[i].half_width);
    EXPECT_EQ(read[0].figures[i].counts, one.figures[i].counts);
  }
  write("scores.jsonl", "no score\n");
  EXPECT_THROW(population::read_scores(path), geometry::Refusal);
}

TEST_F(PopulationTest, ABodyThatCannotBeMadeIsARefusedScore) {
  write("A_truth.json", R"({"landmarks": {}, "heights": {}, "girths": {"neck": 0.35}})");  // and no scan
  const auto family = population::family_named(folder_.string());
  const Score score = population::score_of(*family, "A", population::Input::merged_scan, {});
  EXPECT_EQ(score.refusal.rfind(geometry::refusal::kBrokenFile, 0), 0u) << score.refusal;
  EXPECT_TRUE(score.figures.empty());
  EXPECT_EQ(score.input, "merged scan");
  EXPECT_EQ(population::total_of({score}).refused, 1);
}

std::vector<Score> four_bodies() {
  std::vector<Score> scores;
  const double errors[] = {1, -3, 12, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 4; ++i) {
    Figure bust{"girth bust", errors[i], 9};
    bust.confidence = i < 3 ? 0.8 : -1;
    bust.half_width = i < 3 ? 2 : 0;
    Figure waist{"girth waist", errors[i], 9};
    waist.counts = i == 0;
    waist.hidden = i == 1;
    scores.push_back(
        {"model", "scan", "W" + std::to_string(i), i == 3 ? "not_a_body: no" : "", {bust, waist}});
  }
  return scores;
}

TEST_F(PopulationTest, RowsSayWhatTheBodiesSay) {
  const auto rows = population::rows_of(four_bodies());
  ASSERT_EQ(rows.size(), 2u);
  const population::Row &bust = rows[0], &waist = rows[1];
  EXPECT_EQ(bust.bodies, 4);
  EXPECT_EQ(bust.within, 2);
  EXPECT_EQ(bust.missing, 1);
  EXPECT_NEAR(bust.bias, 10.0 / 3, 1e-12);
  EXPECT_NEAR(bust.deviation, std::sqrt((1 + 9 + 144) / 3.0 - 100.0 / 9), 1e-12);
  EXPECT_EQ(bust.stated, 3);
  EXPECT_EQ(bust.covered, 1);
  EXPECT_EQ(bust.sure, 3);
  EXPECT_EQ(bust.sure_out, 1);
  EXPECT_EQ(bust.worst.front().substr(0, 2), "W3");
  EXPECT_EQ(waist.bodies, 1);
  EXPECT_EQ(waist.left_out, 3);
  const population::Total total = population::total_of(four_bodies());
  EXPECT_EQ(total.all.bodies, 5);
  EXPECT_EQ(total.hidden.bodies, 1);
  EXPECT_EQ(total.refused, 1);
}

TEST_F(PopulationTest, TotalsNameNoBody) {
  const std::string named = population::table("model", four_bodies(), true),
                    bare = population::table("model", four_bodies(), false);
  EXPECT_NE(named.find("W2"), std::string::npos);
  for (const char* name : {"W0", "W1", "W2", "W3"}) EXPECT_EQ(bare.find(name), std::string::npos) << bare;
}

TEST_F(PopulationTest, FamiliesAreSeedsOrAFoldersNames) {
  EXPECT_EQ(population::family_named("model")->bodies(5, 2), (std::vector<std::string>{"5", "6"}));
  for (const char* name : {"B_truth.json", "A_truth.json", "C_truth.json", "other.json"}) write(name, "{}");
  const auto family = population::family_named(folder_.string());
  EXPECT_EQ(family->bodies(1, 2), (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(family->bodies(3, 20), std::vector<std::string>{"C"});
  EXPECT_TRUE(family->bodies(9, 2).empty());
  for (const std::string& name : {std::string("goat"), (folder_ / "none").string()}) {
    try {
      population::family_named(name);
      ADD_FAILURE() << "accepted: " << name;
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kBadOption);
    }
  }
}

}  // namespace
}  // namespace tensegric_fit
