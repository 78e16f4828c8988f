#include "scored_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::population {
namespace {

struct Wanted {
  const char* name;
  double limit;
  bool counts;  ///< false: its definition differs between families, or it is not one that a garment needs
};

constexpr Wanted kGirths[] = {{"bust", 9, true},         {"underbust", 9, true}, {"waist", 9, true},
                              {"hip", 9, true},          {"neck", 4, true},      {"upper_arm_L", 4, false},
                              {"upper_arm_R", 4, false}, {"thigh_L", 9, false},  {"thigh_R", 9, false}};
constexpr Wanted kHeights[] = {{"bust", 4, true}, {"underbust", 4, true}, {"waist", 4, true},
                               {"hip", 4, true},  {"crotch", 4, true},    {"stature", 4, false}};
constexpr Wanted kPoints[] = {
    {"bust_point_L", 5, true}, {"bust_point_R", 5, true},  {"crotch", 10, true},
    {"shoulder_L", 10, true},  {"shoulder_R", 10, true},   {"axilla_L", 10, true},
    {"axilla_R", 10, true},    {"underbust_L", 10, false}, {"underbust_R", 10, false},
    {"buttock_L", 10, false},  {"buttock_R", 10, false},   {"neck_front", 10, false},
    {"neck_back", 10, false},  {"neck_side_L", 10, false}, {"neck_side_R", 10, false}};

constexpr double kMissing = std::numeric_limits<double>::infinity();

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const geometry::Measure* find(const std::vector<geometry::Measure>& measures, const std::string& name) {
  for (const geometry::Measure& measure : measures)
    if (measure.name == name) return &measure;
  return nullptr;
}

Figure blank(const std::string& kind, const Wanted& wanted, const Truth& truth,
             const geometry::BodyMeasures& measured) {
  Figure figure{kind + wanted.name, kMissing, wanted.limit};
  const bool vague = holds(truth.doubts.vague, figure.name);
  const bool hidden = holds(truth.doubts.hidden, figure.name);
  figure.counts = wanted.counts && !vague && !hidden;
  figure.hidden = hidden && !vague;
  figure.cause = "not found";
  for (const geometry::Missing& missing : measured.missing)
    if (missing.name == wanted.name) figure.cause = missing.reason;
  return figure;
}

/// Girth or height, or landmark: what they say of themselves.
template <typename Found>
void take(const Found& found, double millimetres, Figure& figure) {
  figure.error = millimetres;
  figure.confidence = found.confidence;
  figure.half_width = 1e3 * found.half_width;
  figure.cause = found.reason;
}

double distance(const Eigen::Vector3d& found, const Eigen::Vector3d& right, const std::string& name,
                const Truth& truth) {
  Eigen::Vector3d off = found - right;
  for (const auto& [landmark, direction] : truth.doubts.loose)
    if (landmark == name) off -= off.dot(direction.normalized()) * direction.normalized();
  return off.norm();
}

}  // namespace

bool Figure::within() const {
  return std::abs(error) <= limit;  // false for NaN
}

std::vector<Figure> figures_of(const geometry::BodyMeasures& measured, const Truth& truth) {
  std::vector<Figure> figures;
  const auto compare = [&](const std::string& kind, const auto& wanted, const auto& found,
                           const auto& expected) {
    for (const Wanted& w : wanted) {
      const geometry::Measure *value = find(found, w.name), *right = find(expected, w.name);
      if (right == nullptr || (value == nullptr && !w.counts)) continue;
      figures.push_back(blank(kind, w, truth, measured));
      if (value != nullptr) take(*value, 1e3 * (value->metres - right->metres), figures.back());
    }
  };
  compare("girth ", kGirths, measured.girths, truth.measures.girths);
  compare("height ", kHeights, measured.heights, truth.measures.heights);
  for (const Wanted& w : kPoints) {
    const geometry::Landmark *value = measured.find_landmark(w.name),
                             *right = truth.measures.find_landmark(w.name);
    if (right == nullptr || (value == nullptr && !w.counts)) continue;
    figures.push_back(blank("point ", w, truth, measured));
    if (value != nullptr)
      take(*value, 1e3 * distance(value->position, right->position, w.name, truth), figures.back());
  }
  return figures;
}

}  // namespace tensegric_fit::population
