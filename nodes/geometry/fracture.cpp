#include "geometry/fracture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tensegric_fit::geometry {
namespace {

constexpr double kDoubtful = 0.4;  // below 0.5, the threshold of a trusted measure

/// Where a height is read; nowhere of the stature.
std::vector<Eigen::Vector3d> read_at(const std::string& height, const BodyMeasures& measures) {
  std::vector<Eigen::Vector3d> places;
  for (const std::string& name : landmarks_of_height(height))
    if (const Landmark* landmark = measures.find_landmark(name)) places.push_back(landmark->position);
  if (height == "waist")  // where the girth is least: all of its tape counts
    for (const GirthLoop& loop : measures.loops)
      if (loop.name == height) places.insert(places.end(), loop.points.begin(), loop.points.end());
  return places;
}

/// Doubts what is read at some points that a fracture has one of; of several, the widest one counts.
template <class Found>
void doubt_at(const std::vector<Eigen::Vector3d>& points, const std::vector<Fracture>& fractures,
              Found& found) {
  const Fracture* widest = nullptr;
  for (const Fracture& fracture : fractures)
    if ((widest == nullptr || fracture.offset > widest->offset) &&
        std::any_of(points.begin(), points.end(), [&fracture](const Eigen::Vector3d& point) {
          return (point - fracture.centre).norm() <= fracture.radius;
        }))
      widest = &fracture;
  if (widest == nullptr) return;
  found.confidence = std::min(found.confidence, kDoubtful);
  if (found.half_width > 0) found.half_width = std::hypot(found.half_width, widest->offset);  // 0: unknown
  found.reason += (found.reason.empty() ? "" : "; ") +
                  std::string("the person moved: the scan shows skin twice here, ") +
                  std::to_string(std::lround(1000 * widest->offset)) + " mm apart";
}

}  // namespace

void doubt_fractured(const std::vector<Fracture>& fractures, BodyMeasures& measures) {
  for (Landmark& landmark : measures.landmarks) doubt_at({landmark.position}, fractures, landmark);
  for (Measure& height : measures.heights) doubt_at(read_at(height.name, measures), fractures, height);
  for (const GirthLoop& loop : measures.loops)
    for (Measure& girth : measures.girths)
      if (girth.name == loop.name) doubt_at(loop.points, fractures, girth);
}

}  // namespace tensegric_fit::geometry
