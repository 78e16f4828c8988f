#include "inspect/words.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "geometry/shipped_files.hpp"
#include "inspect/panel_words.hpp"
#include "inspect/pressure_words.hpp"
#include "inspect/warning_words.hpp"

namespace tensegric_fit::inspect::words {
namespace {

TEST(Words, SayWhetherTheSkinIsTighterOrLooser) {
  EXPECT_EQ(value_there(ColourBy::distortion, 0.93), "skin area 93 %: pressed together");
  EXPECT_EQ(value_there(ColourBy::distortion, 1.001), "skin area 100 %: unchanged");
  EXPECT_EQ(value_there(ColourBy::stretch, 1.2), "skin length 120 %: longer");
  EXPECT_EQ(value_there(ColourBy::displacement, 0.0123), "moved 12.3 mm");
  EXPECT_EQ(value_there(ColourBy::plain, 1), "");
  EXPECT_EQ(position({0.121, -0.08, 1.182}), "12.1 cm forward, 8.0 cm to her right, 118.2 cm up");
}

TEST(Words, SayWhichPartsOfABodyAreMissing) {
  geometry::BodyMeasures measures;
  EXPECT_EQ(missing(measures), "");
  measures.missing = {{"axilla_L", ""}, {"neck", ""}, {"upper_arm_L", "its girth"}};
  EXPECT_EQ(missing(measures), "") << "figures, and the girth of an arm that is there";
  measures.missing.insert(measures.missing.end(), {{"upper_arm_L", ""}, {"hand_R", ""}, {"crown", ""}});
  EXPECT_EQ(missing(measures), "Missing: left upper arm, right hand, top of the head");
  measures.girths = {{"thigh_R", 0.5, 1, ""}};
  measures.missing = {{"thigh_R", "though its girth was measured"}};
  EXPECT_EQ(missing(measures), "Missing: right thigh");
  measures.missing.assign(11, {"hand_L", ""});
  EXPECT_EQ(missing(measures).substr(missing(measures).rfind(',')), ", left hand and 3 more");
  EXPECT_EQ(with_names_spoken("only 5 % of it is there, nor is hand_L"),
            "only 5 % of it is there, nor is left hand");
}

TEST(Words, SayPullsInNewtons) {
  EXPECT_EQ(pull(0.04), "0.0 N");
  EXPECT_EQ(pull(9.94), "9.9 N");
  EXPECT_EQ(pull(23.4), "23 N");
  const double half_width = pull_uncertainty();
  EXPECT_EQ(with_uncertainty(23.4), fmt::format("23 ± {:.0f}", 23.4 * half_width));
  EXPECT_EQ(with_uncertainty(4.0), fmt::format("4.0 ± {:.1f}", 4 * half_width));
  EXPECT_NE(
      pull_help(23.4, 1.66)
          .find(fmt::format("23 ± {:.0f} N and presses with up to 1.7 ± {:.1f} kPa: less than a waistband",
                            23.4 * half_width, 1.66 * half_width)),
      std::string::npos);
  EXPECT_EQ(pull_help(23.4, 0).find("kPa"), std::string::npos);
}

// The file's interval is that of its own ratios, and holds what a 95 % interval should: with some forty cases
// of thirteen bodies 90 % is two standard errors below.
TEST(Words, PullsHaveTheUncertaintyOfTheirCases) {
  const YAML::Node file = YAML::LoadFile(geometry::shipped_folder("tissue") + "/newtons.yaml");
  double squares = 0;
  int within = 0;
  for (const auto& ratio : file["ratios"]) {
    const double logarithm = std::log(ratio.second.as<double>());
    squares += logarithm * logarithm;
    within += static_cast<int>(std::abs(logarithm) <= pull_uncertainty());
  }
  const double count = static_cast<double>(file["ratios"].size());
  ASSERT_GE(count, 20);
  EXPECT_NEAR(1.96 * std::sqrt(squares / count), pull_uncertainty(), 0.01);  // ratios have two decimals
  EXPECT_GE(within, 0.9 * count);
}

TEST(Words, SayWhatAPressureMeans) {
  EXPECT_EQ(pressure_meaning(0), "");
  EXPECT_EQ(pressure_meaning(2.2).find("less than"), 0U);
  EXPECT_EQ(pressure_meaning(3).find("more than a waistband"), 0U);
  EXPECT_EQ(pressure_meaning(5).find("wearers complain"), 0U);
  EXPECT_EQ(pressure_warning(4.6), "");
  EXPECT_NE(pressure_warning(5.23).find("5.2 kPa"), std::string::npos);
}

TEST(Words, NameWhatIsWrongWithRvizItself) {
  EXPECT_NE(unknown_frame("booth_1/body").find("'booth_1/body'"), std::string::npos);
  EXPECT_EQ(default_taken("parameter '/inspect/keep_previous_body' is not a number", 120),
            "parameter '/inspect/keep_previous_body' is not a number; 120 s are taken.");
}

TEST(Words, DetailsAreNotSaidToAClerk) {
  EXPECT_EQ(without_details("It folds. (Details: 3 patches.) Loosen it. (Details: 1 patch.)"),
            "It folds. Loosen it.");
  EXPECT_EQ(without_details("It folds. (Details: cut"), "It folds.");
  EXPECT_EQ(without_details("It fits."), "It fits.");
}

TEST(Words, WarnOfSkinThatIsPressedOrStretchedTooFarOnly) {
  EXPECT_EQ(over_constriction(0.85, "left bust point"), "");
  EXPECT_NE(over_constriction(0.72, "left bust point").find("near the left bust point"), std::string::npos);
  EXPECT_NE(over_constriction(0.72, "").find("72.0 %"), std::string::npos);
  EXPECT_EQ(over_constriction(1.2, "navel"), "");
  EXPECT_NE(over_constriction(1.4, "navel").find("Over-stretched near the navel"), std::string::npos);

  EXPECT_EQ(line_warning({0.9, 0.9, 0.4, 0.5, false}), "");
  EXPECT_NE(line_warning({0.6, 0.7, 3, 0.412, true}).find("cannot become shorter than 41.2 cm (70.0 %)"),
            std::string::npos);
  EXPECT_NE(line_warning({1.1, 1, 0, 0.5, false}).find("Slack"), std::string::npos);
  EXPECT_EQ(line_warning({0.9, 0.9, 0.4, 0.5, true}), "");  // another line of the garment is the reason
}

TEST(Words, WarningsSayWhereAndWhatToDo) {
  geometry::BodyMeasures measures;
  measures.landmarks = {{"bust_point_L", {0.2, 0.1, 1.2}, 1, ""}, {"navel", {0.2, 0, 1.0}, 1, ""}};
  EXPECT_EQ(place(measures, {0.15, 0.11, 1.17}), "3 cm below the left bust point");
  EXPECT_EQ(place(measures, {0.15, 0.06, 1.21}), "4 cm to her right of the left bust point");
  EXPECT_EQ(place(measures, {0.2, 0.005, 1.005}), "at the navel");
  EXPECT_EQ(place({}, {0, 0, 1}), "");

  geometry::FitWarning shelf;
  shelf.code = geometry::warning::kShelf;
  shelf.line = "chest";
  shelf.at_rest = {0.15, 0.11, 1.17};
  shelf.area = 8.2e-4;
  shelf.value = 71 * 3.14159265358979 / 180;
  EXPECT_EQ(
      warning(shelf, measures),
      "The skin folds into a shelf 3 cm below the left bust point: 8 cm2 are turned by up to 71 degrees. "
      "Loosen 'chest'.");
  geometry::FitWarning crossing = shelf;
  crossing.code = geometry::warning::kSkinCrosses;
  crossing.value = 0.0032;
  EXPECT_TRUE(crossing.is_warning());
  EXPECT_EQ(
      warning(crossing, measures),
      "Skin passes through skin 3 cm below the left bust point: 3 mm and more. What is shown there is not "
      "to be trusted. Loosen 'chest'.");
  shelf.line.clear();
  EXPECT_EQ(warning(shelf, {}),
            "The skin folds into a shelf: 8 cm2 are turned by up to 71 degrees. Ask for less.");
  geometry::FitWarning slack;
  slack.code = geometry::notice::kUnderConstricted;
  slack.lack = geometry::lack::kSlack;
  slack.line = "strap_L";
  EXPECT_EQ(warning(slack, measures), "'strap_L' is slack: it does not pull. Shorten it.");

  slack.code = geometry::notice::kSkinOverLine;
  slack.value = 0.0072;
  EXPECT_EQ(warning(slack, measures).find("The skin comes 7 mm through 'strap_L'"), 0u);

  slack.code = geometry::notice::kNotScanned;
  slack.value = 0.83;
  EXPECT_EQ(
      warning(slack, measures),
      "The scan did not see the skin under 'strap_L' (83 % of its length): what is shown there is made up.");

  EXPECT_EQ(warnings({}), "");
  EXPECT_EQ(warnings({"One.", "Two."}), "One. Two.");
  EXPECT_EQ(warnings({"One.", "Two.", "Three."}), "One. Two. And 1 more place.");
}

TEST(Words, NeverShowMinusZero) {
  EXPECT_EQ(change(-1e-6), "+0.0 cm");
  EXPECT_EQ(change(-0.0123), "-1.2 cm");
  EXPECT_EQ(volume("bust", 2e-3, 2e-3 * (1 - 1e-9)), "bust: 2.00 l, +0.00 %");
}

TEST(CentimetreChange, IsThatOfWhatStandsBesideIt) {
  EXPECT_EQ(words::centimetre_change(0.2984, 0.2986), "+0.1");  // 29.8 and 29.9
  EXPECT_EQ(words::centimetre_change(1.2351, 1.2214), "-1.4");  // 123.5 and 122.1
  EXPECT_EQ(words::centimetre_change(0.8926, 0.8934), "0");     // 89.3 both
  EXPECT_EQ(words::centimetre_change(0.8425, 0.85), "+0.8");    // printed as 84.2
}

}  // namespace
}  // namespace tensegric_fit::inspect::words
