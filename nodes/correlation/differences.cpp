#include "correlation/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tensegric_fit::correlation {
namespace {

using Eigen::Vector3d;
using geometry::BodyMeasures;
using geometry::Measure;

// A body's measures, and how its frame lies in the body frame before.
struct Measured {
  const BodyMeasures* measures;
  Eigen::Isometry3d body_from_scan;
};

struct Value {
  double metres;
  double confidence;
  std::string reason;
};

std::optional<Value> value_in(const std::vector<Measure>& list, const std::string& name) {
  for (const Measure& m : list)
    if (m.name == name) return Value{m.metres, m.confidence, m.reason};
  return std::nullopt;
}

// How far the soles of that body are above those before.
double soles(const Measured& body) {
  return (body.body_from_scan * body.measures->body_from_scan.inverse()).translation().z();
}

std::optional<Value> height_in(const Measured& body, const std::string& name) {
  std::optional<Value> value = value_in(body.measures->heights, name);
  if (value && name != "stature") value->metres += soles(body);
  return value;
}

// "bust_point_height" or "bust_point_spread".
std::optional<Value> effect_in(const Measured& body, const std::string& point, bool height) {
  const geometry::Landmark *left = body.measures->find_landmark(point + "_L"),
                           *right = body.measures->find_landmark(point + "_R");
  if (left == nullptr || right == nullptr) return std::nullopt;
  const Vector3d l = body.body_from_scan * left->position, r = body.body_from_scan * right->position;
  const geometry::Landmark& unsure = left->confidence < right->confidence ? *left : *right;
  return Value{height ? (l.z() + r.z()) / 2 : (l - r).norm(), unsure.confidence, unsure.reason};
}

std::optional<double> after_in(const std::vector<geometry::ChangedMeasure>& list, const std::string& name) {
  for (const geometry::ChangedMeasure& m : list)
    if (m.before.name == name) return m.after;
  return std::nullopt;
}

// The promise alone, which is `carried`.
void leave_out(Difference& difference, const std::optional<double>& carried, const std::string& reason) {
  difference.simulated = carried;
  difference.worn.reset();
  difference.confidence = 0;
  difference.reason = reason;
}

// `find` looks a value up in one body; empty where it was not measured before. `carried`: what the simulation
// itself makes of it.
template <typename Find>
void add(std::vector<Difference>& list, const std::string& name, const std::vector<Measured>& bodies,
         const std::optional<double>& carried, const Find& find) {
  std::vector<std::optional<Value>> values;
  for (const Measured& body : bodies) values.push_back(body.measures == nullptr ? std::nullopt : find(body));
  if (!values[0]) return;
  Difference difference{name, values[0]->metres, std::nullopt, std::nullopt, 1, ""};
  if (values[1]) difference.simulated = values[1]->metres;
  if (values[2]) difference.worn = values[2]->metres;
  for (const auto& value : values) {
    if (!value || value->confidence >= difference.confidence) continue;
    difference.confidence = value->confidence;
    difference.reason = value->confidence < geometry::kUnsure ? value->reason : "";
  }
  if (values[1] && carried && std::abs(values[1]->metres - *carried) > kElsewhere)
    leave_out(
        difference, carried,
        fmt::format("measured anew on the simulated body it is {:.0f} mm off what the garment made of it, "
                    "so that it cannot be compared",
                    1e3 * std::abs(values[1]->metres - *carried)));
  list.push_back(std::move(difference));
}

}  // namespace

Differences differences_of(const BodyMeasures& before, const geometry::MovedSkin& skin,
                           const BodyMeasures* simulated, const BodyMeasures& worn,
                           const Eigen::Isometry3d& simulated_from_worn) {
  const std::vector<Measured> bodies = {{&before, before.body_from_scan},
                                        {simulated, before.body_from_scan},
                                        {&worn, before.body_from_scan * simulated_from_worn}};
  BodyMeasures moved = before;  // landmarks where the garment took them
  const std::vector<Vector3d> places = geometry::landmarks_after(before, skin);
  for (std::size_t i = 0; i < places.size(); ++i) moved.landmarks[i].position = places[i];
  const std::vector<geometry::ChangedMeasure> girths = geometry::girths_after(before, skin),
                                              heights = geometry::heights_after(before, skin);
  Differences differences;
  for (const std::string point : {"bust_point", "buttock"}) {
    for (const bool height : {true, false}) {
      const std::optional<Value> carried = effect_in({&moved, before.body_from_scan}, point, height);
      add(differences.effects, point + (height ? "_height" : "_spread"), bodies,
          carried ? std::optional(carried->metres) : std::nullopt,
          [&](const Measured& body) { return effect_in(body, point, height); });
    }
  }
  for (const Measure& height : before.heights)
    add(differences.heights, height.name, bodies, after_in(heights, height.name),
        [&](const Measured& body) { return height_in(body, height.name); });
  for (const Measure& girth : before.girths) {
    add(differences.girths, girth.name, bodies, after_in(girths, girth.name),
        [&](const Measured& body) { return value_in(body.measures->girths, girth.name); });
    const auto level = std::find_if(differences.heights.begin(), differences.heights.end(),
                                    [&](const Difference& height) { return height.name == girth.name; });
    const bool is_elsewhere = level != differences.heights.end() && level->confidence == 0 && !level->worn;
    if (!is_elsewhere) continue;
    Difference& on_level = differences.girths.back();  // else it would be the girth of another level
    if (on_level.confidence > 0) leave_out(on_level, after_in(girths, girth.name), level->reason);
  }
  return differences;
}

}  // namespace tensegric_fit::correlation
