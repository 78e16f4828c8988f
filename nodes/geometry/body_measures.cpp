#include "geometry/body_measures.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

std::string why_missing(const std::vector<Missing>& missing, const std::string& name) {
  for (const Missing& part : missing)
    if (part.name == name) return ": " + part.reason;
  return "";
}

bool is_limb_girth(const std::string& name) {
  return name.rfind("upper_arm_", 0) == 0 || name.rfind("thigh_", 0) == 0;
}

}  // namespace

bool is_landmark(const std::string& name) {
  return std::find(kLandmarkNames.begin(), kLandmarkNames.end(), name) != kLandmarkNames.end();
}

const Landmark* BodyMeasures::find_landmark(const std::string& name) const {
  const auto found =
      std::find_if(landmarks.begin(), landmarks.end(), [&name](const Landmark& l) { return l.name == name; });
  return found == landmarks.end() ? nullptr : &*found;
}

const Eigen::Vector3d& BodyMeasures::landmark(const std::string& name) const {
  const Landmark* found = find_landmark(name);
  if (found == nullptr)
    throw Refusal(std::string(refusal::kMissingPart) + ":" + name,
                  "the landmark " + name + " was not found on the body" + why_missing(missing, name));
  return found->position;
}

double BodyMeasures::height(const std::string& name) const {
  const auto found =
      std::find_if(heights.begin(), heights.end(), [&name](const Measure& m) { return m.name == name; });
  if (found == heights.end())
    throw Refusal(std::string(refusal::kMissingPart) + ":" + name,
                  "the " + name + " level was not found on the body" + why_missing(missing, name));
  return found->metres;
}

std::vector<Missing> missing_parts(const BodyMeasures& measures) {
  static const std::set<std::string> kLevels{"bust",   "underbust", "waist",  "hip",
                                             "crotch", "neck",      "stature"};
  std::set<std::string> girths;  // of limbs, that are missing
  std::vector<Missing> parts;
  for (const Missing& what : measures.missing) {
    if (is_landmark(what.name) || kLevels.count(what.name) != 0) continue;
    const bool is_measured = std::any_of(measures.girths.begin(), measures.girths.end(),
                                         [&](const Measure& girth) { return girth.name == what.name; });
    const bool is_girth = is_limb_girth(what.name) && !is_measured && girths.insert(what.name).second;
    if (!is_girth) parts.push_back(what);
  }
  return parts;
}

const std::vector<std::string>& landmarks_of_height(const std::string& height) {
  static const std::vector<std::string> none;
  static const std::map<std::string, std::vector<std::string>> landmarks = {
      {"bust", {"bust_point_L", "bust_point_R"}},
      {"underbust", {"underbust_L", "underbust_R"}},
      {"waist", {"waist_side_L", "waist_side_R"}},
      {"hip", {"buttock_L", "buttock_R"}},
      {"crotch", {"crotch"}},
      {"neck", {"neck_front", "neck_back"}}};
  const auto found = landmarks.find(height);
  return found == landmarks.end() ? none : found->second;
}

}  // namespace tensegric_fit::geometry
