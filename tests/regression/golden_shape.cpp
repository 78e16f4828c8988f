#include "golden_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "geometry/checked_yaml.hpp"
#include "ros/body_messages.hpp"
#include "ros/flat.hpp"
#include "stamp.hpp"
#include "yaml_values.hpp"

namespace tensegric_fit::regression {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// Of a piece of skin, by area. Spread: standard deviation along x, y and z.
struct Summary {
  double area = 0;
  Vector3d centre = Vector3d::Zero(), spread = Vector3d::Zero();
};

struct Shape {
  std::string hash;
  std::map<std::string, Summary> parts;
};

fs::path file_of(const Case& asked) {
  return fs::path(asked.file).parent_path() / "shapes" / (asked.name + ".yaml");
}

geometry::TriangleMesh skin_of(const Recording& recording) {
  geometry::TriangleMesh skin = node::mesh_in(*recording.body);
  if (!recording.deformed.empty()) skin.vertices = node::points_in(recording.deformed.back()->vertices);
  return skin;
}

// Empty where the model does not know it: a few square millimetres, or nothing on another machine.
std::string part_of(const Eigen::Vector3i& triangle, const BodyModel::ConstPtr& model) {
  if (!model) return "skin";
  const auto label = [&](int corner) { return model->mesh_parts.at(triangle[corner]); };
  const auto most = label(1) == label(2) ? label(1) : label(0);
  return most < model->parts.size() ? model->parts[most] : "";
}

Shape shape_of(const Recording& recording) {
  Shape shape;
  const geometry::TriangleMesh skin = skin_of(recording);
  for (const Eigen::Vector3i& t : skin.triangles) {
    const Vector3d &a = skin.vertices[t[0]], &b = skin.vertices[t[1]], &c = skin.vertices[t[2]];
    const double area = geometry::area_vector(a, b, c).norm() / 2;
    const std::string name = part_of(t, recording.model);
    if (name.empty()) continue;
    Summary& part = shape.parts[name];
    part.area += area;
    part.centre += area * (a + b + c) / 3;
    // The mean of x^2 over a triangle.
    part.spread += area * (a.cwiseAbs2() + b.cwiseAbs2() + c.cwiseAbs2() + (a + b + c).cwiseAbs2()) / 12;
  }
  for (auto& [name, part] : shape.parts) {
    if (part.area == 0) continue;
    part.centre /= part.area;
    part.spread = (part.spread / part.area - part.centre.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  }
  const auto hashes = hashes_of(recording);
  shape.hash = hashes.at(recording.deformed.empty() ? "body/mesh" : "body/deformed");
  return shape;
}

Shape read_shape(const std::string& file) {
  const YAML::Node root = geometry::load_yaml_map(file, kBadCase);
  geometry::check_keys(root, {"date", "commit", "hash", "parts"}, file, kBadCase);
  Shape shape;
  shape.hash = geometry::required<std::string>(root, "hash", file, kBadCase);
  if (!root["parts"].IsMap()) throw geometry::Refusal(kBadCase, file + ": 'parts' must be a map");
  for (const auto& entry : root["parts"]) {
    const std::string name = entry.first.Scalar(), where = file + ": " + name;
    geometry::check_keys(entry.second, {"area", "centre", "spread"}, where, kBadCase);
    shape.parts[name] = {geometry::required<double>(entry.second, "area", where, kBadCase),
                         vector_in(entry.second, "centre", where), vector_in(entry.second, "spread", where)};
  }
  return shape;
}

std::string row(const Vector3d& v) {
  return fmt::format("[{:.6f}, {:.6f}, {:.6f}]", v.x(), v.y(), v.z());
}

}  // namespace

bool wants_shape(const Case& asked) {
  return std::any_of(asked.expectations.begin(), asked.expectations.end(),
                     [](const Expectation& expected) { return expected.metric.rfind("shape/", 0) == 0; });
}

Metrics shape_metrics(const Case& asked, const Recording& recording) {
  const fs::path file = file_of(asked);
  if (!wants_shape(asked) || !recording.body || !fs::exists(file)) return {};
  const Shape then = read_shape(file), now = shape_of(recording);
  const auto same_name = [](const auto& a, const auto& b) { return a.first == b.first; };
  double centre = 0, spread = 0, area = 0;
  if (!std::equal(then.parts.begin(), then.parts.end(), now.parts.begin(), now.parts.end(), same_name))
    centre = spread = area = std::numeric_limits<double>::infinity();
  else
    for (const auto& [name, part] : now.parts) {
      const Summary& before = then.parts.at(name);
      for (int axis = 0; axis < 3; ++axis) {
        centre = worse(centre, std::abs(part.centre[axis] - before.centre[axis]));
        spread = worse(spread, std::abs(part.spread[axis] - before.spread[axis]));
      }
      area = worse(area, std::abs(part.area / before.area - 1));
    }
  return {{"shape/centre", centre},
          {"shape/spread", spread},
          {"shape/area", area},
          {"shape/bits", then.hash == now.hash ? "same" : "other"}};
}

bool has_moved(const Case& asked, const Recording& recording) {
  const fs::path file = file_of(asked);
  return !fs::exists(file) || read_shape(file).hash != shape_of(recording).hash;
}

void write_shape(const Case& asked, const Recording& recording) {
  const fs::path file = file_of(asked);
  const Shape shape = shape_of(recording);
  const Stamp stamp = stamp_of(asked.file);
  std::string text = fmt::format(
      "# Skin by parts of the body, as `regression --update` recorded it: area in m^2, centre and spread\n"
      "# (standard deviation by area) along x, y and z of the scan in metres; hash: SHA-256 of the payload.\n"
      "date: {}\ncommit: {}\nhash: {}\nparts:\n",
      stamp.date, stamp.commit, shape.hash);
  for (const auto& [name, part] : shape.parts)
    text += fmt::format("  {}: {{area: {:.6g}, centre: {}, spread: {}}}\n", name, part.area, row(part.centre),
                        row(part.spread));
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace tensegric_fit::regression
