// Templates as data: what is read, what is refused, and that the grid is its own mirror image.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "control_mesh/grid.hpp"
#include "control_mesh/template.hpp"
#include "control_mesh_changed_template.hpp"
#include "control_mesh_templates.hpp"
#include "geometry/status.hpp"
#include "refusal_of.hpp"

namespace tensegric_fit {
namespace {

using control_mesh::refusal_with;

TEST(BustTemplate, HasTheSizeOfThePapers) {
  const auto grid = control_mesh::grid_of(control_mesh::load_template(kBust));
  EXPECT_EQ(grid.outer.size(), 77u);
  EXPECT_EQ(grid.triangles.size(), 120u);
  EXPECT_EQ(std::count(grid.outer_fixed.begin(), grid.outer_fixed.end(), 1), 32);
  EXPECT_EQ(std::count(grid.outer_fixed.begin(), grid.outer_fixed.end(), 0), 45);
  ASSERT_EQ(grid.regions.size(), 1u);
  EXPECT_EQ(grid.regions[0].name, "bust");
  EXPECT_EQ(grid.regions[0].triangles.size(), 120u);
}

TEST(BustTemplate, FixesItsRimAndTheBreastboneBelowTheSkin) {
  const auto pattern = control_mesh::load_template(kBust);
  const auto grid = control_mesh::grid_of(pattern);
  std::vector<char> bound(grid.outer.size(), 0);
  for (const geometry::Edge& edge : geometry::edges_of({grid.outer, grid.triangles}))
    if (edge.right < 0) bound[edge.first] = bound[edge.second] = 1;
  EXPECT_EQ(grid.outer_fixed, bound);
  for (int row = 0; row < pattern.rows; ++row)
    bound[control_mesh::node_at(pattern, row, pattern.middle(), control_mesh::Side::left)] = 1;
  EXPECT_EQ(grid.inner_fixed, bound);
}

TEST(BustTemplate, NamesWhatGarmentsAskFor) {
  const auto grid = control_mesh::grid_of(control_mesh::load_template(kBust));
  EXPECT_GE(grid.node("sternum"), 0);
  for (const std::string stem :
       {"axilla", "bust_point", "collarbone", "upper_breast", "underbust", "side_underbust", "below_bust",
        "underbust_outer", "underbust_inner", "breast_side"})
    for (const char* side : {"_L", "_R"}) EXPECT_GE(grid.node(stem + side), 0) << stem << side;
}

TEST(BustTemplate, GridIsItsOwnMirrorImage) {
  const auto pattern = control_mesh::load_template(kBust);
  const auto grid = control_mesh::grid_of(pattern);
  const auto mirror = [&pattern](int node) {
    const int row = node / pattern.columns, column = node % pattern.columns;
    return row * pattern.columns + pattern.columns - 1 - column;
  };
  const auto key = [](int a, int b, int c) {  // a cyclic turn that starts at the lowest keeps the orientation
    if (b < a && b < c) return std::vector<int>{b, c, a};
    if (c < a && c < b) return std::vector<int>{c, a, b};
    return std::vector<int>{a, b, c};
  };
  std::set<std::vector<int>> triangles;
  for (const auto& t : grid.triangles) triangles.insert(key(t[0], t[1], t[2]));
  ASSERT_EQ(triangles.size(), grid.triangles.size());
  for (const auto& t : grid.triangles)  // a reflection turns triangles over: two corners change places
    EXPECT_EQ(triangles.count(key(mirror(t[0]), mirror(t[2]), mirror(t[1]))), 1u);
  for (std::size_t node = 0; node < grid.names.size(); ++node)
    EXPECT_EQ(grid.names[mirror(static_cast<int>(node))],
              control_mesh::name_on(grid.names[node], control_mesh::Side::right));
}

TEST(BustTemplate, RefusesUnknownKeysByName) {
  EXPECT_NE(refusal_with(kBust, "inner_fixed:", "iner_fixed:").find("'iner_fixed'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "offset: -20", "ofset: -20").find("'ofset'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "{name: bust, rows", "{name: bust, colour: red, rows").find("'colour'"),
            std::string::npos);
}

TEST(BustTemplate, RefusesWhatDoesNotFit) {
  EXPECT_NE(refusal_with(kBust, "columns: 11", "columns: 10").find("'columns'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "rows: 7", "rows: seven").find("'rows'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "row: 3, column: 3", "row: 3, column: 6").find("'column'"),
            std::string::npos);
  EXPECT_NE(refusal_with(kBust, "'######'", "'#####'").find("'fixed'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "least: 0.010", "least: 2.4").find("'least'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "least: 0.010", "least: 0.21").find("'least'"),
            std::string::npos);  // 0.2 m at most
  EXPECT_NE(refusal_with(kBust, "share: 0.6", "share: 6").find("'share'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "regions:", "thickness: [[0.01]]\nregions:").find("'thickness'"),
            std::string::npos);
  EXPECT_NE(refusal_with(kHips, "at: buttock_point_L", "at: buttock_point_R").find("'at'"),
            std::string::npos);
  EXPECT_NE(refusal_with(kBust, "through: [axilla_L", "through: [armpit_L").find("'armpit_L'"),
            std::string::npos);
  EXPECT_NE(
      refusal_with(kBust, "name: bust_point_L, ", "name: bust_point_L, spread: true, ").find("'spread'"),
      std::string::npos);
  EXPECT_NE(refusal_with(kBust, "spread: true", "spread: wide").find("'spread'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "rows: [0, 6]", "rows: [0, 7]").find("'rows'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, "name: sternum", "name: sternum_L").find("'name'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust,
                         "level: {between: [bust_point_L, neck_front], at: 0.34}, angle: {between: "
                         "[bust_point_L, axilla_L], at: 0.48}, ",
                         "")
                .find("row 0, column 0"),
            std::string::npos);
}

TEST(BustTemplate, MayLieOnTheBodyModel) {
  EXPECT_FALSE(control_mesh::load_template(kBust).needs_model());
  EXPECT_TRUE(control_mesh::load_template(kBust).may_use_model());
  const std::string place = "level: {landmark: bust_point_L}, angle: {landmark: axilla_L, offset: -5}, or_";
  const auto refusal = [&](const std::string& by) {
    return refusal_with(kBust, place, by + "}\n  # or_");  // the rest of the line becomes a comment
  };
  EXPECT_EQ(refusal("on_model: [[8461, 0.48], [8453, 0.45], [8454, 0.07]]"), "");
  EXPECT_EQ(refusal("on_model: [[bust_point_L, 0.333], [8453, 0.333], [8454, 0.333]]"), "");  // rounded
  EXPECT_NE(refusal("on_model: [[8461, 0.48], [8453, 0.45]]").find("'on_model' has shares that sum to"),
            std::string::npos);
  EXPECT_NE(refusal("on_model: [[8461, 1.2], [8453, -0.2]]").find("'8461' a share"), std::string::npos);
  EXPECT_NE(refusal("on_model: [[8461, nan], [8453, 1]]").find("'8461' a share"), std::string::npos);
  EXPECT_NE(refusal("on_model: [[-1, 1]]").find("'-1' for a vertex"), std::string::npos);
  EXPECT_NE(refusal("on_model: [[1.5, 1]]").find("'1.5' for a vertex"), std::string::npos);
  EXPECT_NE(refusal("on_model: [[65536, 1]]").find("'65536' for a vertex"), std::string::npos);
  EXPECT_NE(refusal("on_model: [[8461, 0.5], [8461, 0.5]]").find("'8461' twice"), std::string::npos);
  for (const char* list : {"8461", "[]", "[8461, 1]", "[[8461]]", "[[[8461], 1]]", "{vertex: 8461}"})
    EXPECT_NE(refusal(std::string("on_model: ") + list).find("'on_model' must be a list of pairs"),
              std::string::npos)
        << list;
  EXPECT_NE(refusal("landmark: underbust_L, or_on_model: [[8461, 0.5]]").find("'or_on_model' has shares"),
            std::string::npos);
  EXPECT_EQ(refusal("landmark: underbust_L, or_on_model: [[8461, 1]]"), "");
  EXPECT_NE(
      refusal("on_model: [[8461, 1]], or_on_model: [[8461, 1]]").find("'on_model' excludes 'or_on_model'"),
      std::string::npos);
  EXPECT_NE(refusal("landmark: underbust_L, on_model: [[8461, 1]]").find("'on_model' excludes"),
            std::string::npos);
}

TEST(BustTemplate, ANodeHasOnePlace) {
  const std::string level = "level: {landmark: bust_point_L}, ",
                    angle = "angle: {landmark: axilla_L, offset: -5}, ";
  const auto refusal = [&](const std::string& by) { return refusal_with(kBust, level + angle, by); };
  EXPECT_NE(refusal(level).find("'level' and 'angle' go together"), std::string::npos);
  EXPECT_NE(refusal(angle).find("'level' and 'angle' go together"), std::string::npos);
  for (const std::string& other : {level, angle, level + angle})
    EXPECT_NE(refusal("landmark: underbust_L, " + other).find("'landmark' excludes 'level' and 'angle'"),
              std::string::npos);
}

TEST(BustTemplate, APlaceOnTheModelIsMadeOf64PointsAtMost) {
  std::string points;
  for (int i = 0; i < 65; ++i) points += (i == 0 ? "" : ", ") + ("[" + std::to_string(i) + ", 0.0153846]");
  EXPECT_NE(refusal_with(kBust, "[[10602, 0.55], [10616, 0.05], [10615, 0.40]]", "[" + points + "]")
                .find("64 pairs"),
            std::string::npos);
}

TEST(BustTemplate, RefusesARegionByItsPlace) {
  EXPECT_NE(refusal_with(kBust, "{name: bust, rows: [0, 6]", "{name: bust, rows: [0, 7]").find("region 1:"),
            std::string::npos);
}

TEST(BustTemplate, RefusesNamesThatStandTwice) {
  EXPECT_NE(refusal_with(kBust, "{name: bust, rows",
                         "{name: bust, rows: [0, 1], columns: [4, 6]}\n  - {name: bust, rows")
                .find("'bust' twice"),
            std::string::npos);
  EXPECT_NE(refusal_with(kBust, "lines:",
                         "lines:\n  - {name: one, through: [axilla_L, axilla_R]}\n"
                         "  - {name: one, through: [axilla_R, axilla_L]}")
                .find("'one' twice"),
            std::string::npos);
  EXPECT_NE(refusal_with(kBust, "through: [axilla_L", "through: [axilla_L, axilla_L").find("twice in a row"),
            std::string::npos);
}

TEST(BustTemplate, RefusesARegionOfNoCell) {
  EXPECT_NE(refusal_with(kHips, "regions:", "regions:\n  - {name: corner, rows: [4, 5], columns: [6, 7]}")
                .find("'corner' has no cell"),
            std::string::npos);
}

TEST(BustTemplate, RefusesNamesOfNoLandmark) {
  const auto said = [](const std::string& what, const std::string& by, const std::string& why) {
    return refusal_with(kBust, what, by).find(why) != std::string::npos;
  };
  EXPECT_TRUE(said("axis: [axilla_L, axilla_R]", "axis: [axilla_L, axila_R]", "'axis' has 'axila_R'"));
  EXPECT_TRUE(said("axis_foot: crotch", "axis_foot: crutch", "'axis_foot' has 'crutch'"));
  EXPECT_TRUE(said("neck_front], at: 0.34}", "throat], at: 0.34}", "level: 'between' has 'throat'"));
  EXPECT_TRUE(said("axilla_L], at: 0.48}", "armpit_L], at: 0.48}", "angle: 'between' has 'armpit_L'"));
  EXPECT_TRUE(said("landmark: axilla_L, offset: -20", "landmark: armpit_L, offset: -20",
                   "angle: 'landmark' has 'armpit_L'"));
  EXPECT_TRUE(said("below: bust_point_L", "below: bust_pont_L", "'below' has 'bust_pont_L'"));
  EXPECT_TRUE(said("landmark: underbust_L, or_on_model", "landmark: under_bust_L, or_on_model",
                   "'landmark' has 'under_bust_L'"));
  EXPECT_NE(refusal_with(kHips, "axis: [hip_side_L, crotch]", "axis: [hip_side_L, knee_L]")
                .find("'axis' has 'knee_L'"),
            std::string::npos);
}

TEST(BustTemplate, RefusesKeysWithoutEffect) {
  const std::string angle = "angle: {landmark: axilla_L, offset: -20",
                    below = "below: bust_point_L, by: 0.03",
                    on_middle = "angle: {between: [bust_point_L, bust_point_R], at: 0.5";
  EXPECT_NE(refusal_with(kBust, angle, angle + ", " + below).find("unknown key 'below'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, angle, angle + ", by: 0.03").find("unknown key 'by'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, below, "by: 0.03").find("'by' needs 'below'"), std::string::npos);
  EXPECT_NE(refusal_with(kBust, on_middle, on_middle + ", offset: 5").find("'offset'"), std::string::npos);
  EXPECT_EQ(refusal_with(kBust, on_middle, on_middle + ", offset: 0"), "");
}

TEST(BustTemplate, RefusesMoreThanAnyBodyNeeds) {
  const auto many = [](const std::string& key, int more, const std::string& of_each) {
    std::string text = key;
    for (int i = 0; i < more; ++i) text += "\n  - {name: n" + std::to_string(i) + ", " + of_each + "}";
    return refusal_with(kBust, key, text);
  };
  const std::string everywhere = "rows: [0, 6], columns: [0, 10]", across = "through: [axilla_L, axilla_R]";
  EXPECT_EQ(many("regions:", 63, everywhere), "");
  EXPECT_NE(many("regions:", 64, everywhere).find("'regions' must have 64"), std::string::npos);
  EXPECT_EQ(many("lines:", 999, across), "");
  EXPECT_NE(many("lines:", 1000, across).find("'lines' must have 1000"), std::string::npos);
  std::string to_and_fro = "through: [axilla_L";
  for (int i = 0; i < 500; ++i) to_and_fro += ", axilla_R, axilla_L";
  EXPECT_NE(refusal_with(kBust, "through: [axilla_L", to_and_fro).find("1000 nodes in 'through'"),
            std::string::npos);
}

TEST(BustTemplate, WithOthersItSharesNoNameAndItsBoneIsHeld) {
  const auto refused = [](const std::vector<control_mesh::Template>& patterns) {
    return refusal_of([&] { control_mesh::check_together(patterns); });
  };
  const auto bust = control_mesh::load_template(kBust), hips = control_mesh::load_template(kHips);
  EXPECT_EQ(refused({bust, hips}), "accepted");
  EXPECT_EQ(refused({bust, bust}), "bad_template");
  auto namesake = hips;
  namesake.lines.front().name = bust.lines.front().name;
  EXPECT_EQ(refused({bust, namesake}), "bad_template") << "two lines of one name";
  auto loose = bust;
  for (std::string& row : loose.fixed) row.assign(row.size(), '.');
  EXPECT_EQ(refused({loose}), "bad_template");
  loose.fixed.front() = "##....";  // two on either side
  EXPECT_EQ(refused({loose}), "accepted");
  loose.inner_fixed = false;
  EXPECT_EQ(refused({loose}), "bad_template") << "a bone hangs on inner nodes";
  loose.bone.reset();
  for (std::string& row : loose.fixed) row.assign(row.size(), '.');
  EXPECT_EQ(refused({loose}), "accepted") << "bound tissue holds all inner nodes";
}

TEST(BustTemplate, RefusesAFileThatIsNotThere) {
  try {
    control_mesh::load_template("no_such_template.yaml");
    FAIL() << "accepted";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "bad_template");
  }
}

}  // namespace
}  // namespace tensegric_fit
