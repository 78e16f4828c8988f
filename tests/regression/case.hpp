/// Cases of the regression harness: what goes in, and what is expected to come out (cases/*.yaml).
#pragma once

#include <tensegric_fit/Garment.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "recipe.hpp"

namespace tensegric_fit::regression {

inline constexpr char kBadCase[] = "bad_case";  ///< code of all refusals of case files

/// A number, or a word (a status, a refusal's code).
using Value = std::variant<double, std::string>;
std::string to_text(const Value& value);

/// What one metric must be.
struct Expectation {
  std::string metric;
  std::optional<Value> value;  ///< none: never recorded so far
  double tolerance = 0;        ///< of numbers, either way
  std::string reason;          ///< why this value and this tolerance
  bool golden = false;         ///< recorded from a run, so that --update may replace it; else it is asked for
};

/// Why golden values were replaced.
struct Update {
  std::string reason;
  std::string date, commit;                                           ///< empty: of before they were kept
  std::map<std::string, std::pair<std::string, std::string>> values;  ///< old and new, by metric
};

struct Case {
  std::string name;  ///< the file's, without its ending
  std::string file;
  std::string about;  ///< a sentence for people
  std::string bag;    ///< a recorded scan; empty: by the recipe
  Recipe booth;
  YAML::Node pipeline;            ///< parameters by stage, over those of launch/config/pipeline.yaml
  std::vector<Garment> garments;  ///< worn one after the other; none: measured only. No two have one name
  bool own_garments = false;      ///< the bag has them
  std::vector<Expectation> expectations;
  std::vector<Update> updates;  ///< oldest first

  bool measure_only() const { return garments.empty(); }
  /// What comes is a cloud a sensor, and is assembled first.
  bool sensors() const { return booth.sensors || (pipeline["assembler"] && !bag.empty()); }
};

/// Keys: about, booth or bag, scene (bust, hips, bust+hips; measure), pipeline, garments (names of shipped
/// garments, or maps of name, ratio, ratios, stiffness; or the word `recorded`: those of the bag), expect
/// (names of files in cases/expect with further metrics), metrics (name: {expected or golden, tolerance,
/// reason}), updates (a reason, or {date, commit, reason, values: {metric: [old, new]}}). \throw Refusal
/// bad_case naming file and key; bad_garment, unknown_line
Case load_case(const std::string& file);

/// All cases of a folder by name, or only those named. \throw Refusal bad_case: no such case
std::vector<Case> load_cases(const std::string& folder, const std::vector<std::string>& names);

}  // namespace tensegric_fit::regression
