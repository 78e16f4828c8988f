#include "geometry/fracture.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tensegric_fit::geometry {
namespace {

constexpr double kDoubtful = 0.4;  // below 0.5, the threshold of a trusted measure

const Fracture* fracture_at(const std::vector<Fracture>& fractures, const Eigen::Vector3d& point) {
  for (const Fracture& fracture : fractures)
    if ((point - fracture.centre).norm() <= fracture.radius) return &fracture;
  return nullptr;
}

template <class Found>
void doubt(const Fracture& fracture, Found& found) {
  found.confidence = std::min(found.confidence, kDoubtful);
  found.reason += (found.reason.empty() ? "" : "; ") +
                  std::string("the person moved: the scan shows skin twice here, ") +
                  std::to_string(std::lround(1000 * fracture.offset)) + " mm apart";
}

}  // namespace

void doubt_fractured(const std::vector<Fracture>& fractures, BodyMeasures& measures) {
  for (Landmark& landmark : measures.landmarks)
    if (const Fracture* fracture = fracture_at(fractures, landmark.position)) doubt(*fracture, landmark);
  for (const GirthLoop& loop : measures.loops) {
    const Fracture* met = nullptr;
    for (const Eigen::Vector3d& point : loop.points)
      if (met == nullptr) met = fracture_at(fractures, point);
    if (met == nullptr) continue;
    for (Measure& girth : measures.girths)
      if (girth.name == loop.name) doubt(*met, girth);
  }
}

}  // namespace tensegric_fit::geometry
