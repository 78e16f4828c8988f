// Garment files: every key is checked, and the garments that the product ships are read.
#include "tensegric/garment.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "geometry/status.hpp"
#include "refusal_of.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

class GarmentFile {
 public:
  explicit GarmentFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("garment_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~GarmentFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string refusal(const std::string& text) {
  const GarmentFile file(text);
  try {
    load_garment(file.path());
  } catch (const geometry::Refusal& r) {
    EXPECT_EQ(r.code(), geometry::refusal::kBadGarment);
    return r.what();
  }
  ADD_FAILURE() << "not refused:\n" << text;
  return {};
}

std::string with_line(const std::string& line) {
  return "name: G\nregion: bust\nlines:\n  - {name: chest, " + line + "}\n";
}

TEST(Garment, ReadsEveryKey) {
  const GarmentFile file(
      "name: G\nregion: [bust, hips]\nlines:\n"
      "  - {name: a, ratio: 0.9, law: rigid, through: [p, q], follow: taut, tension_limit: 2}\n"
      "  - {name: b, law: {stiffness: 3}}\n"
      "  - {name: c, law: {table: [[1.1, 2], [1.2, 5]]}}\n");
  const Garment g = load_garment(file.path());
  EXPECT_EQ(g.regions, (std::vector<std::string>{"bust", "hips"}));
  ASSERT_EQ(g.lines.size(), 3U);
  EXPECT_EQ(g.lines[0].ratio, 0.9);
  EXPECT_TRUE(g.lines[0].taut);
  EXPECT_EQ(g.lines[0].tension_limit, 2);
  EXPECT_EQ(g.lines[0].through, (std::vector<std::string>{"p", "q"}));
  EXPECT_EQ(g.lines[1].law.kind, TensionLaw::Kind::stiffness);
  EXPECT_EQ(g.lines[1].law.stiffness, 3);
  EXPECT_EQ(g.lines[1].ratio, 1);
  EXPECT_FALSE(g.lines[1].taut);
  ASSERT_EQ(g.lines[2].law.table.size(), 3U);  // no tension at stretch 1 is understood
  EXPECT_EQ(g.lines[2].law.table[0], std::make_pair(1.0, 0.0));
}

TEST(Garment, RefusesByTheNameOfTheKey) {
  EXPECT_NE(refusal("name: G\nregion: bust\nlines: [{name: a}]\ncolour: red\n").find("'colour'"),
            std::string::npos);
  for (const char* key : {"points", "width", "smooth"})
    EXPECT_NE(refusal(with_line(std::string(key) + ": 1")).find("'" + std::string(key) + "'"),
              std::string::npos);
  EXPECT_NE(refusal(with_line("ratoi: 0.9")).find("'ratoi'"), std::string::npos);
  EXPECT_NE(refusal(with_line("ratio: 0")).find("'ratio'"), std::string::npos);
  EXPECT_NE(refusal(with_line("ratio: .nan")).find("'ratio'"), std::string::npos);
  EXPECT_NE(refusal(with_line("ratio: narrow")).find("'ratio'"), std::string::npos);
  EXPECT_NE(refusal(with_line("law: rubber")).find("'law'"), std::string::npos);
  EXPECT_NE(refusal(with_line("law: {stiffness: -1}")).find("'stiffness'"), std::string::npos);
  EXPECT_NE(refusal(with_line("law: {table: [[1.2, 3], [1.1, 4]]}")).find("'table'"), std::string::npos);
  EXPECT_NE(refusal(with_line("law: {table: [[1.2, 3, 4]]}")).find("'table'"), std::string::npos);
  EXPECT_NE(refusal(with_line("follow: air")).find("'follow'"), std::string::npos);
  EXPECT_NE(refusal(with_line("follow: taut")).find("'follow'"),
            std::string::npos);  // of the template's own course
  for (const char* nodes : {"through: [a]", "through: []"})
    EXPECT_NE(refusal(with_line(nodes)).find("'through'"), std::string::npos) << nodes;
  EXPECT_NE(refusal(with_line("law: {stiffness: 0}")).find("'stiffness'"), std::string::npos);
  for (const char* limit : {"tension_limit: -3", "tension_limit: 0", "tension_limit: .inf"})
    EXPECT_NE(refusal(with_line(limit)).find("'tension_limit'"), std::string::npos) << limit;
  EXPECT_NE(refusal("name: G\nlines: [{name: a}]\n").find("'region'"), std::string::npos);
  EXPECT_NE(refusal("name: G\nregion: bust\n").find("'lines'"), std::string::npos);
  EXPECT_NE(refusal("name: G\nregion: bust\nlines: [{name: a}, {name: a}]\n").find("'a'"), std::string::npos);
  EXPECT_NE(refusal("- a\n").find("map"), std::string::npos);
  EXPECT_THROW(load_garment("/nowhere/garment.yaml"), geometry::Refusal);
}

TEST(Garment, EndsOfALineByPointsAreHeldByBoneOrCarriedBySkin) {
  const std::string points = "points: [[0, 0, 1], [0.1, 0, 1]]";
  const auto held = [](const std::string& text) {
    const GarmentFile file(with_line(text));
    return load_garment(file.path()).lines.front().held;
  };
  EXPECT_EQ(held(points), (std::array<bool, 2>{true, true}));
  EXPECT_EQ(held(points + ", ends: [bone, skin]"), (std::array<bool, 2>{true, false}));
  EXPECT_EQ(held(points + ", ends: [skin, bone]"), (std::array<bool, 2>{false, true}));
  EXPECT_NE(refusal(with_line(points + ", ends: [bone, air]")).find("'air'"), std::string::npos);
  for (const char* ends : {"ends: bone", "ends: [bone]", "ends: [bone, bone, skin]", "ends: {first: bone}"})
    EXPECT_NE(refusal(with_line(points + ", " + ends)).find("'ends'"), std::string::npos) << ends;
  // A line by `through` ends as its last node does.
  EXPECT_NE(refusal(with_line("through: [a, b], ends: [bone, skin]")).find("'ends'"), std::string::npos);
}

TEST(Garment, ALineThroughNodesIsABandUnlessItSaysOtherwise) {
  const auto line = [](const std::string& words) {
    const GarmentFile file(with_line(words));
    return load_garment(file.path()).lines.front();
  };
  EXPECT_EQ(line("through: [a, b]").width, kBandWidth);
  EXPECT_EQ(line("through: [a, b]").smooth, kBandSmooth);
  EXPECT_EQ(line("through: [a, b], width: 0.015").width, 0.015);
  EXPECT_TRUE(line("through: [a, b]").on_body());
  const GarmentLine string = line("through: [a, b], width: 0");
  EXPECT_EQ(string.smooth, 0);
  EXPECT_FALSE(string.on_body());
  EXPECT_NE(refusal(with_line("through: [a, b], width: 0, smooth: 0.02")).find("'smooth'"),
            std::string::npos);
  EXPECT_NE(refusal(with_line("through: [a, b], width: 0.3")).find("'width'"), std::string::npos);
}

TEST(Garment, ALineThatSpreadsIsACup) {
  const std::string cup = "through: [a], fan: [p, q, r]";
  const GarmentFile file(with_line(cup));
  const GarmentLine line = load_garment(file.path()).lines.front();
  EXPECT_EQ(line.through, std::vector<std::string>{"a"});
  EXPECT_EQ(line.fan, (std::vector<std::string>{"p", "q", "r"}));
  EXPECT_EQ(line.width, kBandWidth);  // where it begins
  EXPECT_EQ(line.smooth, kBandSmooth);
  for (const char* fan : {"through: [a], fan: p", "through: [a], fan: []", "through: [a], fan: {p: q}",
                          "fan: [p, q]", "points: [[0, 0, 1], [0.1, 0, 1]], fan: [p, q]"})
    EXPECT_NE(refusal(with_line(fan)).find("'fan'"), std::string::npos) << fan;
  EXPECT_NE(refusal(with_line(cup + ", width: 0")).find("'width'"), std::string::npos);
  EXPECT_NE(refusal(with_line(cup + ", ends: [bone, skin]")).find("'ends'"), std::string::npos);
}

TEST(Garment, ShippedGarmentsAreRead) {
  for (const char* name : {"B1", "B2", "B3", "B4", "cups"}) {
    const Garment g =
        load_garment(std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/garments/" + name + ".yaml");
    EXPECT_EQ(g.name, name);
    EXPECT_EQ(g.regions, std::vector<std::string>{"bust"});
    EXPECT_FALSE(g.lines.empty());
  }
}

TEST(Garment, ARatioIsThatOfOneLineOrOfAll) {
  Garment g = take_garment("B4", std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/garments");
  ASSERT_GT(g.lines.size(), 1u);
  set_ratio(g, "", 0.93);
  for (const GarmentLine& line : g.lines) EXPECT_EQ(line.ratio, 0.93);
  set_ratio(g, g.lines[0].name, 0.91);
  EXPECT_EQ(g.lines[0].ratio, 0.91);
  for (std::size_t i = 1; i < g.lines.size(); ++i) EXPECT_EQ(g.lines[i].ratio, 0.93);
  EXPECT_EQ(refusal_of([&] { set_ratio(g, "hem", 0.9); }), "unknown_line");
  EXPECT_EQ(refusal_of([&] { set_ratio(g, "", 1e3); }), "bad_garment");
  try {
    set_ratio(g, g.lines[0].name, 90);
    FAIL() << "a percentage";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(std::string(refusal.what()),
              "garment " + g.name + ", line '" + g.lines[0].name + "': 'ratio' is 90; 90 % is 0.9");
  }
}

TEST(Garment, ALineOfOneSideMayRunAlongTheMiddleButNotOverTheOtherSideAlone) {
  geometry::ControlMesh control = bust_mesh();
  control.names[5] = "below";  // of the middle column
  control.names[71] = "above";
  const Model model = build_model(control, {});
  const auto outcome = [&](std::vector<std::string> through) {
    Garment g = chest(0.97);
    g.lines[0].name = "cup_L";
    g.lines[0].through = std::move(through);
    return refusal_of([&] { solve(model, g, {}); });
  };
  EXPECT_EQ(outcome({"below", "sternum", "above"}), "accepted");
  EXPECT_EQ(outcome({"bust_point_L", "axilla_L"}), "accepted");
  EXPECT_EQ(outcome({"bust_point_R", "sternum", "bust_point_L"}), "accepted");  // a strap may cross
  EXPECT_EQ(outcome({"bust_point_R", "axilla_R"}), "bad_garment");
  EXPECT_EQ(outcome({"sternum", "bust_point_R"}), "bad_garment");
}

TEST(Garment, SeveralAreWornAtOnce) {
  const std::string folder = std::string(TENSEGRIC_FIT_SOURCE_DIR) + "/launch/garments";
  const Garment b1 = take_garment("B1", folder), b4 = take_garment("B4", folder);
  const Garment both = take_garment("B1+B4", folder);
  EXPECT_EQ(both.name, "B1+B4");
  EXPECT_EQ(both.regions, std::vector<std::string>{"bust"});  // named once
  ASSERT_EQ(both.lines.size(), b1.lines.size() + b4.lines.size());
  EXPECT_EQ(both.lines.back().name, b4.lines.back().name);
  for (const char* wrong : {"B1+B1", "B1+", "+", "B1+none"})
    EXPECT_THROW(take_garment(wrong, folder), geometry::Refusal) << wrong;
  const GarmentFile own(with_line("ratio: 0.9"));
  EXPECT_EQ(take_garment(own.path() + "+B4", folder).name, "G+B4")
      << "the file's own name, not where it lies";
}

}  // namespace
}  // namespace tensegric_fit::tensegric
