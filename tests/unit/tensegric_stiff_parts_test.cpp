// Tissue with a stiff part: a scar or a prosthesis in one breast.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "fit/tissue_file.hpp"
#include "geometry/status.hpp"
#include "tensegric/solver.hpp"
#include "tensegric_bust.hpp"

namespace tensegric_fit::tensegric {
namespace {

Solution worn(const std::vector<StiffPart>& parts) {
  ModelOptions options;
  options.stiff_parts = parts;
  return solve(build_model(bust_mesh(), options), chest(0.92), {});
}

template <typename Action>
void expect_bad_option(const Action& action) {
  try {
    action();
    ADD_FAILURE() << "not refused";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), geometry::refusal::kBadOption) << refusal.what();
  }
}

/// m, of skin around a named node: the mean.
double motion_around(const Solution& solution, const std::string& name) {
  const geometry::ControlMesh control = bust_mesh();
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < control.outer.size(); ++i)
    if ((control.outer[i] - control.outer[control.node(name)]).norm() < 0.05) {
      sum += (solution.outer[i] - control.outer[i]).norm();
      ++count;
    }
  return sum / count;
}

TEST(StiffParts, MoveLessThanTheOtherBreast) {
  const Solution plain = worn({}), stiff = worn({{"bust_point_L", 0.06, 5}});
  ASSERT_EQ(stiff.status, Status::converged);
  EXPECT_NEAR(motion_around(plain, "bust_point_L"), motion_around(plain, "bust_point_R"), 1e-9);
  EXPECT_LT(motion_around(stiff, "bust_point_L"), 0.9 * motion_around(stiff, "bust_point_R"));
  EXPECT_NEAR(stiff.lines[0].final / plain.lines[0].final, 1, 1e-6);  // the request is met all the same
  EXPECT_NEAR(stiff.regions[0].volume_after / stiff.regions[0].volume_before, 1, 1e-9);
}

TEST(StiffParts, MirroredPartsMirrorTheShape) {
  const Solution left = worn({{"bust_point_L", 0.06, 5}}), right = worn({{"bust_point_R", 0.06, 5}});
  EXPECT_NEAR(motion_around(left, "bust_point_L"), motion_around(right, "bust_point_R"), 1e-9);
  EXPECT_NEAR(motion_around(left, "bust_point_R"), motion_around(right, "bust_point_L"), 1e-9);
}

TEST(StiffParts, AsStiffAsTheRestChangesNothing) {
  EXPECT_EQ(worn({{"bust_point_L", 0.06, 1}}).outer, worn({}).outer);
}

TEST(StiffParts, EverywhereStiffPullsHarderAndMovesAlike) {
  ModelOptions plain;
  plain.skin = 0;  // it is not of the tissue
  ModelOptions stiff = plain;
  stiff.stiff_parts = {{"sternum", 0.3, 4}};
  const Model models[] = {build_model(bust_mesh(), plain), build_model(bust_mesh(), stiff)};
  const Solution worn[] = {solve(models[0], chest(0.92), {}), solve(models[1], chest(0.92), {})};
  for (std::size_t i = 0; i < worn[0].outer.size(); ++i)
    EXPECT_LT((worn[0].outer[i] - worn[1].outer[i]).norm(), 1e-7);
  EXPECT_NEAR(
      worn[1].lines[0].tension * models[1].newtons() / (worn[0].lines[0].tension * models[0].newtons()), 4,
      1e-4);
}

TEST(StiffParts, AreReadAndWrittenAlike) {
  const StiffPart part = stiff_part_from("bust_point_L 0.05 4");
  EXPECT_EQ(part.around, "bust_point_L");
  EXPECT_EQ(part.radius, 0.05);
  EXPECT_EQ(part.times, 4);
  EXPECT_EQ(to_string(part), "bust_point_L 0.05 4");
}

TEST(StiffParts, GoThroughATissueFile) {
  const std::string path = testing::TempDir() + "stiff_parts.yaml";
  fit::Settings read;
  std::ofstream(path) << "stiff_parts: [bust_point_L 0.05 4, sternum 0.02 0.5]\n";
  fit::take_tissue(path, read);
  ASSERT_EQ(read.model.stiff_parts.size(), 2U);
  EXPECT_EQ(to_string(read.model.stiff_parts[1]), "sternum 0.02 0.5");
  EXPECT_EQ(to_string(read.model.stiff_parts[0]), "bust_point_L 0.05 4");
}

TEST(StiffParts, BadOnesAreRefused) {
  for (const char* text :
       {"", "bust_point_L", "bust_point_L 0.05", "bust_point_L far 4", "bust_point_L 0.05 4 5"})
    expect_bad_option([&] { stiff_part_from(text); });
  for (const StiffPart& part : {StiffPart{"nowhere", 0.05, 4}, StiffPart{"bust_point_L", 0, 4},
                                StiffPart{"bust_point_L", 0.05, 1000}, StiffPart{"bust_point_L", 0.05, NAN}})
    expect_bad_option([&] { worn({part}); });
  ModelOptions papers = papers_model();
  papers.stiff_parts = {{"bust_point_L", 0.05, 4}};
  expect_bad_option([&] { build_model(bust_mesh(), papers); });
}

}  // namespace
}  // namespace tensegric_fit::tensegric
