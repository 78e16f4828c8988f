/// Virtual customers of cases: who stands in the booth, and what it sees of her.
#pragma once

#include <yaml-cpp/yaml.h>

#include <limits>
#include <string>

#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::regression {

struct Recipe {
  int customer = -1;  ///< drawn at random with this seed; -1: by the parameters below
  virtual_body::BodyParameters body;
  virtual_booth::ScannerOptions scanner;
  double crop_above = std::numeric_limits<double>::infinity();  ///< m above the floor: nothing there is seen
  double unit = 1;                                              ///< of the scan's coordinates, metres
  bool sensors = false;  ///< what comes is a cloud a sensor, as from a booth of several; else one scan
};

/// From a map whose keys are the fields of BodyParameters and ScannerOptions by name, or `customer` in their
/// place (virtual_booth --customer), beside `points`, `crop_above`, `unit` and `sensors`. \throw Refusal
/// bad_case: also numbers of these keys out of range
Recipe read_recipe(const YAML::Node& map, const std::string& where);

struct Customer {
  virtual_body::VirtualBody body;  ///< the truth
  geometry::PointCloud scan;
  std::vector<virtual_booth::SensorScan> sensors;  ///< the same points, where each sensor sends its own
};

/// Same recipe, same bits. \throw Refusal bad_option
Customer make_customer(const Recipe& recipe);

}  // namespace tensegric_fit::regression
