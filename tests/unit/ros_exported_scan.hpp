/// A fitted scan to be exported, and a folder for its exports.
#pragma once

#include <gtest/gtest.h>
#include <tensegric_fit/GarmentLine.h>
#include <unistd.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/export_fit.hpp"
#include "ros/export_folders.hpp"

namespace tensegric_fit::node {

namespace fs = std::filesystem;

inline const ExportOptions kWhole{true};
inline constexpr double kPi = 3.14159265358979323846;

/// A trunk: a tube of 0.15 m, open above and below.
inline geometry::TriangleMesh tube() {
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

inline geometry::GirthLoop loop_at(const std::string& name, double height) {
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
      std::vector<geometry::Refusal> left;
      delete_exports(directory, scan_id, left);
      if (!left.empty()) return left.front().code();
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  }

  const fs::path root_ = fs::temp_directory_path() / ("tensegric_fit_export_" + std::to_string(getpid()));
  FittedScan scan_;
};

}  // namespace tensegric_fit::node
