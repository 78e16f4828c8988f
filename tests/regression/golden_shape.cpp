#include "golden_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "geometry/status.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "surface_distance.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPoints = 2500;
constexpr double kUnit = 1e-4;  // m

fs::path file_of(const Case& asked) {
  return fs::path(asked.file).parent_path() / "shapes" / (asked.name + ".txt");
}

geometry::TriangleMesh skin_of(const Recording& recording) {
  geometry::TriangleMesh skin = node::mesh_in(*recording.body);
  if (!recording.deformed.empty()) skin.vertices = node::points_in(recording.deformed.back()->vertices);
  return skin;
}

std::vector<Eigen::Vector3d> read_shape(const fs::path& path) {
  std::vector<Eigen::Vector3d> points;
  std::ifstream file(path);
  for (int x, y, z; file >> x >> y >> z;) points.push_back(kUnit * Eigen::Vector3d(x, y, z));
  if (!file.eof() || points.empty())
    throw geometry::Refusal(
        kBadCase, fmt::format("{}: line {}: not x y z in whole numbers", path.string(), points.size() + 1));
  return points;
}

}  // namespace

bool wants_shape(const Case& asked) {
  return std::any_of(asked.expectations.begin(), asked.expectations.end(),
                     [](const Expectation& expected) { return expected.metric.rfind("shape/", 0) == 0; });
}

Metrics shape_metrics(const Case& asked, const Recording& recording) {
  const fs::path file = file_of(asked);
  if (!wants_shape(asked) || !recording.body || !fs::exists(file)) return {};
  const std::vector<double> off = gauge::distances(read_shape(file), {}, skin_of(recording));
  return {{"shape/p95", gauge::quantile(off, 0.95)}, {"shape/most", gauge::quantile(off, 1)}};
}

bool write_shape(const Case& asked, const Recording& recording) {
  const std::vector<Eigen::Vector3d> points = skin_of(recording).vertices;
  std::string text;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() / kPoints)) {
    const Eigen::Vector3d tenths = points[i] / kUnit;
    text +=
        fmt::format("{} {} {}\n", std::lround(tenths.x()), std::lround(tenths.y()), std::lround(tenths.z()));
  }
  const fs::path file = file_of(asked);
  std::ifstream in(file);
  if (text == std::string{std::istreambuf_iterator<char>(in), {}}) return false;
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
  return true;
}

}  // namespace tensegric_fit::regression
