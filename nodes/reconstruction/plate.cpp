#include "reconstruction/plate.hpp"

#include <cmath>
#include <vector>

#include "body_model/missing_parts.hpp"
#include "geometry/percentile.hpp"
#include "geometry/point_tree.hpp"

namespace tensegric_fit::reconstruction {
namespace {

// Tolerances.
constexpr double kLevelNormal = 0.95;  // of a normal's z, 18 degrees: noise tilts those of a plane by less
constexpr double kBesideFeet = 0.02;   // m from her skin: beyond the soles of a shoe
constexpr std::size_t kFewestOfTop = 100;  // points: its height is known to an eighth of their noise

}  // namespace

std::optional<Plate> find_plate(const geometry::PointCloud& cloud, const body_model::RegisteredBody& model,
                                const body_model::Standing& standing) {
  const double soles = body_model::ground_by_soles(model, standing).height;
  if (soles < kThinnestPlate || body_model::lowest_of_soles(model) < kThinnestPlate / 2 ||
      body_model::lacks_feet(model))
    return std::nullopt;
  const geometry::PointTree skin(model.skin);
  std::vector<double> heights;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (std::abs(cloud.points[i].z() - soles) < kThinnestPlate && cloud.normals[i].z() > kLevelNormal &&
        !skin.any_within(cloud.points[i], kBesideFeet, [](int) { return true; }))
      heights.push_back(cloud.points[i].z());
  if (heights.size() < kFewestOfTop) return std::nullopt;
  const double top = geometry::median(heights);
  for (double& height : heights) height = std::abs(height - top);
  return Plate{top, geometry::robust_deviation(heights)};
}

}  // namespace tensegric_fit::reconstruction
