#include "truth_reader.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geometry/status.hpp"

namespace tensegric_fit::population {
namespace {

Eigen::Vector3d triple(const nlohmann::json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

std::vector<geometry::Measure> measures(const nlohmann::json& map) {
  std::vector<geometry::Measure> list;
  for (const auto& [name, value] : map.items())
    if (value.is_number()) list.push_back({name, value.get<double>(), 1, ""});
  return list;
}

void take_least_neck(Truth& truth) {
  std::vector<geometry::Measure>& girths = truth.measures.girths;
  const auto named = [&](const char* name) {
    return std::find_if(girths.begin(), girths.end(),
                        [name](const geometry::Measure& m) { return m.name == name; });
  };
  if (named("neck_min") == girths.end()) return;
  const double least = named("neck_min")->metres;
  if (named("neck") != girths.end()) girths.erase(named("neck"));
  girths.push_back({"neck", least, 1, ""});
  std::vector<std::string>& vague =
      truth.doubts.vague;  // what it says of the neck is about the ruler's level
  vague.erase(std::remove(vague.begin(), vague.end(), "girth neck"), vague.end());
}

Truth truth_in(const nlohmann::json& file, bool of_surface) {
  Truth truth;
  for (const auto& [name, place] : file.at("landmarks").items())
    if (place.is_array()) truth.measures.landmarks.push_back({name, triple(place), 1, ""});
  truth.measures.heights = measures(file.at("heights"));
  truth.measures.girths = measures(file.at("girths"));
  truth.doubts.vague = file.value("vague", std::vector<std::string>());
  const char* hidden = of_surface && file.contains("hidden_on_surface") ? "hidden_on_surface" : "hidden";
  truth.doubts.hidden = file.value(hidden, std::vector<std::string>());
  const nlohmann::json loose = file.value("loose", nlohmann::json::object());
  for (const auto& [name, direction] : loose.items())
    truth.doubts.loose.emplace_back(name, triple(direction));
  const std::string waist =
      file.value("extra", nlohmann::json::object()).value("waist_method", std::string());
  if (!file.contains("vague") && waist.find("ruler") != std::string::npos)
    truth.doubts.vague = {"girth waist", "height waist"};
  take_least_neck(truth);
  return truth;
}

}  // namespace

Truth read_truth(const std::string& path, bool of_surface) {
  std::ifstream file(path);
  if (!file) throw geometry::Refusal(geometry::refusal::kBrokenFile, path + ": cannot be read");
  try {
    return truth_in(nlohmann::json::parse(file), of_surface);
  } catch (const nlohmann::json::exception& error) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile, path + ": " + error.what());
  }
}

}  // namespace tensegric_fit::population
