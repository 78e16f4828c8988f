#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::population {
namespace {

constexpr double kMissing = std::numeric_limits<double>::infinity();

struct Wanted {
  const char* name;
  double limit;
};

constexpr Wanted kGirths[] = {{"bust", 9},        {"underbust", 9}, {"waist", 9},
                              {"hip", 9},         {"neck", 4},      {"upper_arm_L", 4},
                              {"upper_arm_R", 4}, {"thigh_L", 9},   {"thigh_R", 9}};
constexpr Wanted kHeights[] = {{"bust", 4}, {"underbust", 4}, {"waist", 4},
                               {"hip", 4},  {"crotch", 4},    {"stature", 4}};
constexpr Wanted kPoints[] = {
    {"bust_point_L", 5}, {"bust_point_R", 5}, {"underbust_L", 10}, {"underbust_R", 10}, {"crotch", 10},
    {"shoulder_L", 10},  {"shoulder_R", 10},  {"neck_back", 10},   {"neck_front", 10},  {"neck_side_L", 10},
    {"neck_side_R", 10}, {"axilla_L", 10},    {"axilla_R", 10},    {"buttock_L", 10},   {"buttock_R", 10}};

const geometry::Measure* find(const std::vector<geometry::Measure>& measures, const std::string& name) {
  for (const geometry::Measure& measure : measures)
    if (measure.name == name) return &measure;
  return nullptr;
}

std::string why_missing(const geometry::BodyMeasures& measured, const std::string& name) {
  for (const geometry::Missing& missing : measured.missing)
    if (missing.name == name) return missing.reason;
  return "not found";
}

}  // namespace

bool Error::within() const {
  return std::abs(millimetres) <= limit;  // false for NaN
}

std::vector<Error> errors_of(const geometry::BodyMeasures& measured, const geometry::BodyMeasures& truth,
                             bool has_waist) {
  std::vector<Error> errors;
  const auto compare = [&](const std::string& kind, const auto& wanted, const auto& found,
                           const auto& expected) {
    for (const Wanted& w : wanted) {
      const geometry::Measure *value = find(found, w.name), *right = find(expected, w.name);
      if (!right || (!has_waist && w.name == std::string("waist"))) continue;
      errors.push_back({kind + w.name, value ? 1e3 * (value->metres - right->metres) : kMissing, w.limit,
                        value ? value->reason : why_missing(measured, w.name)});
    }
  };
  compare("girth ", kGirths, measured.girths, truth.girths);
  compare("height ", kHeights, measured.heights, truth.heights);
  for (const Wanted& w : kPoints) {
    const geometry::Landmark *value = measured.find_landmark(w.name), *right = truth.find_landmark(w.name);
    if (right)
      errors.push_back({std::string("point ") + w.name,
                        value ? 1e3 * (value->position - right->position).norm() : kMissing, w.limit,
                        value ? value->reason : why_missing(measured, w.name)});
  }
  return errors;
}

std::vector<Row> summary(const std::vector<std::vector<Error>>& bodies, const std::vector<int>& seeds) {
  struct Sums {
    double sum = 0, squares = 0;
    std::vector<double> sizes;
  };
  std::vector<Row> rows;
  std::vector<Sums> sums;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const Error& error : bodies[b]) {
      const auto same = [&error](const Row& row) { return row.measure == error.measure; };
      const std::size_t i = std::find_if(rows.begin(), rows.end(), same) - rows.begin();
      if (i == rows.size()) {
        rows.push_back({error.measure, error.limit});
        sums.emplace_back();
      }
      Row& row = rows[i];
      const double size = std::abs(error.millimetres);
      ++row.bodies;
      row.within += error.within();
      if (row.bodies == 1 || size > row.largest) {
        row.largest = size;
        row.worst = seeds[b];
      }
      if (!std::isfinite(size)) {
        ++row.missing;
        continue;
      }
      sums[i].sum += error.millimetres;
      sums[i].squares += error.millimetres * error.millimetres;
      sums[i].sizes.push_back(size);
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<double>& sizes = sums[i].sizes;
    const auto count = static_cast<double>(sizes.size());
    if (sizes.empty()) continue;
    rows[i].mean = sums[i].sum / count;
    if (count > 1) {
      const double variance = (sums[i].squares - count * rows[i].mean * rows[i].mean) / (count - 1);
      rows[i].interval = 1.96 * std::sqrt(std::max(0.0, variance) / count);
    }
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<long>(sizes.size() / 2), sizes.end());
    rows[i].median = sizes[sizes.size() / 2];
  }
  return rows;
}

}  // namespace tensegric_fit::population
