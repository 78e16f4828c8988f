#include "recipe.hpp"

#include <algorithm>

#include "case.hpp"
#include "geometry/checked_yaml.hpp"
#include "virtual_booth/random_body.hpp"
#include "yaml_values.hpp"

namespace tensegric_fit::regression {
namespace {

virtual_booth::Fracture fracture_in(const YAML::Node& map, const std::string& where) {
  geometry::check_keys(map, {"centre", "radii", "shift", "from_column"}, where, kBadCase);
  return {vector_in(map, "centre", where), vector_in(map, "radii", where), vector_in(map, "shift", where),
          geometry::required<int>(map, "from_column", where, kBadCase)};
}

}  // namespace

Recipe read_recipe(const YAML::Node& map, const std::string& where) {
  geometry::check_keys(map, {"customer",  "points",   "crop_above",
                             "unit",      "stature",  "build",
                             "bust",      "firmness", "asymmetry",
                             "waist",     "belly",    "hip",
                             "arm_angle", "stoop",    "yaw",
                             "tilt",      "columns",  "sensors_per_column",
                             "distance",  "noise",    "outliers",
                             "grazing",   "floor",    "frame",
                             "seed",      "fracture", "misregistration",
                             "sensors"},
                       where, kBadCase);
  if (map["customer"])
    geometry::check_keys(map, {"customer", "points", "crop_above", "unit", "sensors"},
                         where + ": beside 'customer'", kBadCase);
  Recipe recipe;
  const auto read = [&](const char* key, auto& field) {
    field = geometry::optional(map, key, field, where, kBadCase);
  };
  const auto check = [&](const char* key, double low, double high) {
    if (map[key]) geometry::number_in(map, key, low, high, where, kBadCase);
  };
  read("customer", recipe.customer);
  read("points", recipe.scanner.points);
  read("crop_above", recipe.crop_above);
  read("unit", recipe.unit);
  read("sensors", recipe.sensors);
  check("customer", 0, std::numeric_limits<int>::max());
  check("crop_above", 0, 10);
  check("unit", 1e-6, 1000);
  virtual_body::BodyParameters& body = recipe.body;
  for (const auto& [key, field] : {std::pair("stature", &body.stature),
                                   {"build", &body.build},
                                   {"bust", &body.bust},
                                   {"firmness", &body.firmness},
                                   {"asymmetry", &body.asymmetry},
                                   {"waist", &body.waist},
                                   {"belly", &body.belly},
                                   {"hip", &body.hip},
                                   {"arm_angle", &body.arm_angle},
                                   {"stoop", &body.stoop},
                                   {"yaw", &body.yaw},
                                   {"tilt", &body.tilt}})
    read(key, *field);
  virtual_booth::ScannerOptions& scanner = recipe.scanner;
  for (const auto& [key, field] : {std::pair("distance", &scanner.distance),
                                   {"noise", &scanner.noise},
                                   {"outliers", &scanner.outliers},
                                   {"misregistration", &scanner.misregistration},
                                   {"grazing", &scanner.grazing}})
    read(key, *field);
  read("columns", scanner.columns);
  read("sensors_per_column", scanner.sensors_per_column);
  read("floor", scanner.floor);
  read("frame", scanner.frame);
  read("seed", scanner.seed);
  if (recipe.sensors && (map["crop_above"] || map["unit"]))
    throw geometry::Refusal(kBadCase, where + ": 'sensors' goes with neither 'crop_above' nor 'unit'");
  if (map["fracture"]) scanner.fracture = fracture_in(map["fracture"], where + ": fracture");
  return recipe;
}

Customer make_customer(const Recipe& recipe) {
  const bool by_lot = recipe.customer >= 0;
  const auto seed = static_cast<std::uint64_t>(recipe.customer);
  Customer customer;
  customer.body = virtual_body::make_body(by_lot ? virtual_booth::random_body(seed) : recipe.body);
  virtual_booth::ScannerOptions scanner =
      by_lot ? virtual_booth::random_scanner(seed, customer.body) : recipe.scanner;
  scanner.points = std::min(scanner.points, recipe.scanner.points);
  const virtual_booth::VirtualScan scan = virtual_booth::scan_body(customer.body.mesh, scanner);
  if (recipe.sensors) customer.sensors = virtual_booth::by_sensor(scan);
  customer.scan = scan.cloud;
  auto& points = customer.scan.points;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Eigen::Vector3d& p) { return p.z() > recipe.crop_above; }),
               points.end());
  for (Eigen::Vector3d& p : points) p /= recipe.unit;
  return customer;
}

}  // namespace tensegric_fit::regression
