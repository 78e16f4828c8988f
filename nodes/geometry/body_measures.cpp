#include "geometry/body_measures.hpp"

#include <algorithm>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

std::string why_missing(const std::vector<Missing>& missing, const std::string& name) {
  for (const Missing& part : missing)
    if (part.name == name) return ": " + part.reason;
  return "";
}

}  // namespace

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

}  // namespace tensegric_fit::geometry
