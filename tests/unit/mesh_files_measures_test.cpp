// Measures for pattern tools: what is a guess says so.
#include <gtest/gtest.h>

#include <cmath>

#include "mesh_files/measures_file.hpp"

namespace tensegric_fit::mesh_files {
namespace {

std::vector<MeasureEntry> sure_and_unsure() {
  MeasureEntry bust{{"bust", 0.942, 0.5, "", 0.004}, true, 0.9, {}, {}},
      underbust{{"underbust", 0.75, 0.4, "hair, <b>\"long\"</b> & wet\n\xff", 0.0123}, true, {}, {}, {}},
      waist{{"waist", 0.7, 0.1, ""}, true, 0.65, {}, {}}, neck{{"neck", 1.45, 0.9, ""}, false, 1.45, {}, {}};
  neck.back = geometry::Measure{"neck_back", 1.43, 0.3, "a collar", 0.021};
  neck.back_worn = 1.42;
  return {bust, underbust, waist, neck};
}

void expect_line(const std::string& vit, const std::string& name, const std::string& value,
                 const std::string& description) {
  EXPECT_NE(vit.find("    <m name=\"" + name + "\" value=\"" + value + "\" description=\"" + description +
                     "\" full_name=\"\"/>\n"),
            std::string::npos)
      << name << " in\n"
      << vit;
}

TEST(Vit, DescribesUnsureFiguresAndListsThemInTheNotes) {
  const std::string vit = measures_vit(sure_and_unsure(), false),
                    hair =
                        "unsure: +- 12 mm, hair, &lt;b&gt;&quot;long&quot;&lt;/b&gt; &amp; wet \xEF\xBF\xBD",
                    collar = "unsure: +- 21 mm, a collar";
  expect_line(vit, "bust_circ", "94.2", "");
  expect_line(vit, "lowbust_circ", "75.0", hair);
  expect_line(vit, "waist_circ", "70.0", "unsure");
  expect_line(vit, "height_neck_back", "143.0", collar);
  EXPECT_NE(vit.find("<notes>before the garment\nlowbust_circ: " + hair +
                     "\nwaist_circ: unsure\nheight_neck_back: " + collar + "</notes>"),
            std::string::npos)
      << vit;
}

TEST(Vit, UnderTheGarmentIsAsUnsureAsBefore) {
  const std::string vit = measures_vit(sure_and_unsure(), true);
  expect_line(vit, "bust_circ", "90.0", "");
  expect_line(vit, "waist_circ", "65.0", "unsure");
  expect_line(vit, "height_neck_back", "142.0", "unsure: +- 21 mm, a collar");
  EXPECT_EQ(vit.find("lowbust_circ"), std::string::npos) << "unknown under the garment";
  EXPECT_NE(vit.find("<notes>under the garment\nwaist_circ: unsure\n"), std::string::npos) << vit;
}

// A neck's tape is smoothed and lies beside the skin in places: it was shorter by what was clipped there,
// under any garment.
TEST(MeasureEntries, AGarmentThatMovesNothingChangesNoTape) {
  constexpr int kCorners = 60;
  geometry::TriangleMesh pipe;
  geometry::BodyMeasures measures;
  measures.girths = {{"neck", 0.377, 0.9, ""}};
  measures.loops = {{"neck", {}}};
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / kCorners, x = std::cos(angle), y = std::sin(angle);
    pipe.vertices.emplace_back(0.06 * x, 0.06 * y, 0);
    pipe.vertices.emplace_back(0.06 * x, 0.06 * y, 0.1);
    measures.loops[0].points.emplace_back(0.061 * x, 0.059 * y, 0.05);
    const int a = 2 * i, b = 2 * ((i + 1) % kCorners);
    pipe.triangles.emplace_back(a, b, b + 1);
    pipe.triangles.emplace_back(a, b + 1, a + 1);
  }
  for (const double size : {1.0, 0.9}) {
    std::vector<Eigen::Vector3d> skin = pipe.vertices;
    for (Eigen::Vector3d& p : skin) p.head<2>() *= size;
    const std::vector<geometry::ChangedMeasure> heights,
        girths{{measures.girths[0], measures.girths[0].metres * size}};
    const WornBody worn{skin, heights, girths};
    const std::vector<MeasureEntry> entries = measure_entries(pipe, measures, &worn);
    ASSERT_EQ(entries.size(), 1u);
    ASSERT_TRUE(entries[0].loop && entries[0].loop_worn);
    const double tolerance = size == 1 ? 1e-12 : 0.004;
    EXPECT_NEAR(entries[0].loop_worn->tape, size * entries[0].loop->tape, tolerance);
    EXPECT_NEAR(entries[0].loop_worn->skin, size * entries[0].loop->skin, tolerance);
  }
}

TEST(Vit, OfSureFiguresHasNoMoreNotes) {
  const std::string vit = measures_vit({sure_and_unsure().front()}, false);
  EXPECT_NE(vit.find("<notes>before the garment</notes>"), std::string::npos) << vit;
}

}  // namespace
}  // namespace tensegric_fit::mesh_files
