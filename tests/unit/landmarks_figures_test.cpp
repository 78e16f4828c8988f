// What is made of two readings of one figure, on mesh and on body model.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "geometry/status.hpp"
#include "landmarks/figures.hpp"

namespace tensegric_fit::landmarks {
namespace {

using Eigen::Vector3d;

constexpr double kSupport = 0.003, kMisfit = 0.005;  // m
/// The mesh is 3 mm off there, hypot(0.0018, 0.8 * 0.003); the model 5 mm, hypot(0.00064 * (5 mm / 2 mm)^2, 1
/// * 0.003).
constexpr double kOfMesh = 0.003, kOfModel = 0.005, kHalfWidth = 2, kHalfWidthOfModel = 3,
                 kDisagreement = 0.1;

Precision precision() {
  const FigurePrecision p{
      {0, 0.0018, 0, 0.8}, {0, 0.00064, 2, 1}, kDisagreement, kHalfWidth, kHalfWidthOfModel};
  FigurePrecision of_scan = p;
  of_scan.half_width = 2 * kHalfWidth;
  return {
      {{"girth bust", p}, {"height bust", p}, {"point bust_point", p}}, {{"girth bust", of_scan}}, {}, {}};
}

Figure girth(std::optional<double> on_mesh, std::optional<double> on_model) {
  const auto value = [](std::optional<double> v) {
    return v ? std::optional<Vector3d>(Vector3d(*v, 0, 0)) : std::nullopt;
  };
  return {Kind::girth, "bust", value(on_mesh), value(on_model), kSupport, kMisfit, {}};
}

TEST(Settle, OneReadingIsTakenAsItIs) {
  const Settled mesh = settle(girth(0.9, {}), precision(), false),
                model = settle(girth({}, 0.9), precision(), false);
  EXPECT_EQ(mesh.value.x(), 0.9);
  EXPECT_NEAR(mesh.half_width, kHalfWidth * kOfMesh, 1e-12);
  EXPECT_EQ(model.value.x(), 0.9);
  EXPECT_FALSE(mesh.rests_on_model);
  EXPECT_TRUE(model.rests_on_model);
  EXPECT_NEAR(model.half_width, kHalfWidthOfModel * kOfModel, 1e-12);
}

TEST(Settle, AReadingThatSkinMayHaveMovedCountsForLess) {
  const double apart = 0.004, factor = 2, shift = 0.002;  // 3 mm and 4 mm: 5 mm, as the model
  Precision known = precision();
  known.of_mesh.at("girth bust").mesh.shift = factor;
  Figure figure = girth(0.9 + apart, 0.9);
  figure.shift = shift;
  const Settled settled = settle(figure, known, false);
  EXPECT_NEAR(settled.value.x(), 0.9 + apart / 2, 1e-12);
  EXPECT_NEAR(settled.half_width, kHalfWidth * std::hypot(kOfModel * std::sqrt(0.5), kDisagreement * apart),
              1e-12);
}

TEST(Settle, TwoReadingsCountByTheirPrecision) {
  const double apart = 0.004;
  const Settled both = settle(girth(0.9 + apart, 0.9), precision(), false);
  // Weights are inverse squares: 1/9 to 1/25.
  EXPECT_NEAR(both.value.x(), 0.9 + apart * 25 / 34, 1e-12);
  EXPECT_NEAR(both.half_width, kHalfWidth * std::hypot(kOfMesh * std::sqrt(25.0 / 34), kDisagreement * apart),
              1e-12);
  const Settled agreed = settle(girth(0.9, 0.9), precision(), false);
  EXPECT_LT(agreed.half_width, both.half_width);
  EXPECT_LT(agreed.half_width, settle(girth(0.9, {}), precision(), false).half_width);
}

TEST(Settle, OutsideTheModelsSpanReadingsAreLessSureByDegrees) {
  const auto half_width = [](double misfit, bool scanned) {
    Precision precision{{}, {}, {0.002, 0.003}, {0.003, 0.005}};
    precision.of_mesh["girth bust"] = precision.of_scan["girth bust"] = {
        {0, 0.001, 0, 0, 0.002}, {0, 0.004, 0, 0}, kDisagreement, kHalfWidth, kHalfWidthOfModel};
    Figure figure = girth(0.9, {});
    figure.misfit = misfit;
    return settle(figure, precision, scanned).half_width;
  };
  EXPECT_EQ(half_width(0.001, false), kHalfWidth * 0.001);
  EXPECT_EQ(half_width(0.002, false), kHalfWidth * 0.001);  // no step where it begins
  EXPECT_NEAR(half_width(0.0025, false), kHalfWidth * std::hypot(0.001, 0.001), 1e-12);
  EXPECT_NEAR(half_width(0.003, false), kHalfWidth * std::hypot(0.001, 0.002), 1e-12);
  EXPECT_EQ(half_width(0.1, false), half_width(0.003, false));  // and it ends
  EXPECT_NEAR(half_width(0.004, true), kHalfWidth * std::hypot(0.001, 0.001), 1e-12);
}

TEST(Settle, AReadingGrosslyOffIsLeftOut) {
  // Four spreads are 23 mm; three of ISO 20685's limits, of a large girth, 27.
  const Settled near = settle(girth(0.9 + 0.0201, 0.9), precision(), false),
                nearly = settle(girth(0.9 + 0.0269, 0.9), precision(), false),
                far = settle(girth(0.9 + 0.0271, 0.9), precision(), false);
  EXPECT_GT(near.value.x(), 0.91);
  EXPECT_NEAR(nearly.value.x(), far.value.x(), 0.001);  // neither the value jumps there, nor its interval
  EXPECT_NEAR(nearly.half_width / far.half_width, 1, 0.02);
  EXPECT_GE(far.half_width, near.half_width);
  EXPECT_FALSE(nearly.rests_on_model);
  EXPECT_EQ(far.value.x(), 0.9);
  EXPECT_FALSE(near.rests_on_model);
  EXPECT_TRUE(far.rests_on_model);
  Figure taped = girth(0.9 + 0.0271, 0.9);
  taped.loop = {{1, 0, 0}};
  taped.loop_on_model = {{2, 0, 0}};
  EXPECT_EQ(tape_of(taped, near), taped.loop);
  EXPECT_EQ(tape_of(taped, far), taped.loop_on_model) << "the tape is that of the girth";
  EXPECT_GT(far.half_width,
            kHalfWidthOfModel * kOfModel);  // the model alone, less sure than if nothing spoke against it
  Figure point = girth({}, {});
  point.kind = Kind::point;
  point.name =
      "bust_point_R";  // both sides share their precision; three limits of 5 mm are less than four spreads
  point.on_model = Vector3d(0.1, -0.08, 1.2);
  for (const auto& [off, left_out] : {std::pair(0.0230, false), std::pair(0.0236, true)}) {
    point.on_mesh = *point.on_model + Vector3d(0, 0, off);
    EXPECT_EQ(settle(point, precision(), false).value == *point.on_model, left_out) << off;
  }
  point.seen = true;  // skin that the scan backs is hers, however far off the model is
  EXPECT_FALSE(settle(point, precision(), false).rests_on_model);
}

TEST(Settle, WhatReadingsAreOffOnAverageIsTakenOff) {
  Precision biased = precision();
  FigurePrecision& p = biased.of_mesh["girth bust"];
  p.mesh.bias = 0.002;
  p.model.bias = -0.001;
  EXPECT_NEAR(settle(girth(0.902, {}), biased, false).value.x(), 0.9, 1e-12);
  EXPECT_NEAR(settle(girth({}, 0.899), biased, false).value.x(), 0.9, 1e-12);
  const Settled both = settle(girth(0.902, 0.899), biased, false),
                agreed = settle(girth(0.9, 0.9), precision(), false);
  EXPECT_NEAR(both.value.x(), 0.9, 1e-12);
  EXPECT_NEAR(both.half_width, agreed.half_width, 1e-12);
}

TEST(Settle, AHeightIsNoSurerThanTheGround) {
  const double ground = 0.004, apart = 0.001;
  for (const auto& [on_mesh, on_model] : {std::pair<std::optional<double>, std::optional<double>>(1.2, {}),
                                          {{}, 1.2},
                                          {1.2 + apart, 1.2},
                                          {1.2 + 0.1, 1.2}}) {
    Figure height = girth(on_mesh, on_model);
    height.kind = Kind::height;
    const Settled floor_seen = settle(height, precision(), false);
    height.ground = ground;
    const Settled without_floor = settle(height, precision(), false);
    EXPECT_NEAR(without_floor.half_width, std::hypot(floor_seen.half_width, 1.96 * ground), 1e-12);
    EXPECT_EQ(without_floor.value, floor_seen.value);  // both readings are off by the same
  }
}

TEST(Settle, ScansHaveAPrecisionOfTheirOwn) {
  EXPECT_NEAR(settle(girth(0.9, {}), precision(), true).half_width,
              2 * settle(girth(0.9, {}), precision(), false).half_width, 1e-12);
}

TEST(Settle, AFigureThatThePrecisionLacksIsNamed) {
  Figure hip = girth(0.9, 0.9);
  hip.name = "hip";
  try {
    settle(hip, precision(), false);
    ADD_FAILURE() << "settled";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), geometry::refusal::kBrokenFile);
    EXPECT_NE(std::string(refusal.what()).find("girth hip"), std::string::npos) << refusal.what();
  }
}

TEST(Reasons, AnUncertainGroundNamesBothOfItsCauses) {
  Figure height = girth(1.2, 1.2);
  height.kind = Kind::height;
  const Settled settled = settle(height, precision(), false);
  EXPECT_EQ(reason_of(height, settled).find("ground"), std::string::npos);
  height.ground = 0.004;  // 7.8 mm at 95 %; one and a half times ISO 20685's limit is 6
  for (const char* words : {"the ground is", "no foot is there", "soles and lowest place do not agree"})
    EXPECT_NE(reason_of(height, settled).find(words), std::string::npos) << words;
}

TEST(Limits, AreThoseOfIso20685) {
  const auto limit = [](Kind kind, const char* name) { return limit_of({kind, name, {}, {}, 0, 0, {}}); };
  EXPECT_EQ(limit(Kind::girth, "bust"), 0.009);
  EXPECT_EQ(limit(Kind::girth, "neck"), 0.004);
  EXPECT_EQ(limit(Kind::girth, "upper_arm_L"), 0.004);
  EXPECT_EQ(limit(Kind::height, "hip"), 0.004);
  EXPECT_EQ(limit(Kind::point, "bust_point_L"), 0.005);
  EXPECT_EQ(limit(Kind::point, "crotch"), 0.010);
}

class PrecisionFile : public testing::Test {
 protected:
  void SetUp() override { path_ = testing::TempDir() + "precision_" + std::to_string(getpid()) + ".yaml"; }
  void TearDown() override { std::filesystem::remove(path_); }

  /// The refusal of a file with this text, or "".
  std::string refusal_of(const std::string& text) const {
    std::ofstream(path_) << text;
    try {
      load_precision(path_);
      return "";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kBrokenFile);
      return refusal.what();
    }
  }
  std::string path_;
};

const std::string kFigure =
    "{mesh: {bias: -0.002, base: 0.001, growth: 0, support: 0.1, outside: 0.3}, model: {bias: 0, base: 1, "
    "growth: 1.5, support: 0.2, outside: 0}, "
    "disagreement: "
    "0.1, half_width: 2, half_width_of_model: 3}";

std::string file_with(const std::string& of_bust) {
  return "made: 2026-01-01\nbodies: none\nspan: {mesh: [0.002, 0.003], scan: [0.003, 0.004]}\nmesh:\n  girth "
         "bust: " +
         of_bust + "\nscan:\n  girth bust: " + kFigure + "\n";
}
std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST_F(PrecisionFile, IsReadAsWritten) {
  ASSERT_EQ(refusal_of(file_with(kFigure)), "");
  const Precision read = load_precision(path_);
  ASSERT_EQ(read.of_mesh.size(), 1u);
  const FigurePrecision& bust = read.of_mesh.at("girth bust");
  EXPECT_EQ(bust.mesh.bias, -0.002);
  EXPECT_EQ(bust.mesh.base, 0.001);
  EXPECT_EQ(bust.mesh.support, 0.1);
  EXPECT_EQ(bust.mesh.outside, 0.3);
  EXPECT_EQ(read.mesh_span.women, 0.002);
  EXPECT_EQ(read.mesh_span.others, 0.003);
  EXPECT_EQ(read.scan_span.women, 0.003);
  EXPECT_EQ(read.scan_span.others, 0.004);
  EXPECT_EQ(bust.model.base, 1);
  EXPECT_EQ(bust.model.growth, 1.5);
  EXPECT_EQ(bust.model.support, 0.2);
  EXPECT_EQ(bust.disagreement, 0.1);
  EXPECT_EQ(bust.half_width, 2);
  EXPECT_EQ(bust.half_width_of_model, 3);
}

TEST_F(PrecisionFile, MayHaveAFactorOfShifts) {
  ASSERT_EQ(refusal_of(file_with(replaced(kFigure, "base: 0.001", "shift: 4.5, base: 0.001"))), "");
  const Precision read = load_precision(path_);
  EXPECT_EQ(read.of_mesh.at("girth bust").mesh.shift, 4.5);
  EXPECT_EQ(read.of_scan.at("girth bust").mesh.shift, 0);
}

TEST_F(PrecisionFile, IsRefusedByTheNameOfWhatIsWrong) {
  const auto expect_named = [&](const std::string& text, const std::string& word) {
    EXPECT_NE(refusal_of(text).find(word), std::string::npos) << refusal_of(text);
  };
  expect_named(file_with(replaced(kFigure, "half_width", "width")), "width");
  expect_named(file_with(replaced(kFigure, "growth: 1.5", "growth: 11")), "growth");
  expect_named(file_with(replaced(kFigure, "support: 0.1", "slope: 0.1")), "slope");
  expect_named(file_with(replaced(kFigure, "half_width: 2", "half_width: -2")), "half_width");
  expect_named(file_with(replaced(kFigure, "base: 0.001", "shift: -1, base: 0.001")), "shift");
  expect_named(file_with(replaced(kFigure, "base: 0.001", "base: .nan")), "base");
  expect_named(file_with(replaced(kFigure, "base: 0.001", "base: 1000")), "base");
  expect_named(file_with(replaced(kFigure, "base: 0.001", "base: 0")), "base");
  expect_named(file_with(replaced(kFigure, "base: 0.001", "base: wide")), "base");
  expect_named(file_with(replaced(kFigure, ", disagreement: 0.1", "")), "disagreement");
  expect_named(replaced(file_with(kFigure), "scan:", "cloud:"), "cloud");
  expect_named(file_with(replaced(kFigure, ", outside: 0}", "}")), "outside");
  expect_named(replaced(file_with(kFigure), "span", "range"), "range");
  expect_named(replaced(file_with(kFigure), "[0.003, 0.004]", "[0.004, 0.003]"), "span: scan");
  expect_named(replaced(file_with(kFigure), "[0.003, 0.004]", "[0.003]"), "span: scan");
  expect_named("made: x\nbodies: y\nspan: {mesh: [1, 2], scan: [1, 2]}\nmesh: {}\n", "scan");
  expect_named("mesh: [1, 2]\nscan: {}\n", "mesh");
  expect_named(replaced(file_with(kFigure), "[0.003, 0.004]", "[0.003, wide]"), "scan");
  expect_named(file_with("{disagreement: 0.1, half_width: 2, half_width_of_model: 3}"), "mesh");
  expect_named(replaced(file_with(kFigure), "scan:\n  girth bust:", "scan:\n  [girth, bust]:"), "name");
  expect_named(file_with(kFigure) + "  girth bust: " + kFigure + "\n", "twice");
  expect_named("no map", path_);
  EXPECT_THROW(load_precision(path_ + ".none"), geometry::Refusal);
}

TEST_F(PrecisionFile, TheShippedOneKnowsMeshesAndScansAlike) {
  const Precision& shipped = shipped_precision();
  ASSERT_GE(shipped.of_mesh.size(), 20u);
  for (const auto& entry : shipped.of_mesh) EXPECT_EQ(shipped.of_scan.count(entry.first), 1u) << entry.first;
  EXPECT_EQ(shipped.of_mesh.size(), shipped.of_scan.size());
}

}  // namespace
}  // namespace tensegric_fit::landmarks
