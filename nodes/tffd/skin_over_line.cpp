#include "tffd/skin_over_line.hpp"

#include <algorithm>

#include "geometry/status.hpp"
#include "tffd/line_over_skin.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::tffd {
namespace {

double deepest(const LineOverSkin& line) {
  return line.heights.empty() ? 0
                              : std::max(0.0, -*std::min_element(line.heights.begin(), line.heights.end()));
}

}  // namespace

std::vector<geometry::FitWarning> skin_over_lines(const WornSkin& skin, const std::vector<WornLine>& lines) {
  if (skin.worn.size() != skin.rest.size())
    throw geometry::Refusal(geometry::refusal::kBadMesh, "skin check: not one worn place a vertex");
  std::vector<geometry::FitWarning> all;
  for (const WornLine& line : lines) {
    const LineOverSkin worn = line_over_skin(line.worn, skin.triangles, skin.worn);
    if (deepest(worn) <= kOffSkin) continue;
    const double usual = deepest(line_over_skin(line.at_rest, skin.triangles, skin.rest)) + kOffSkin;
    if (deepest(worn) <= usual) continue;
    geometry::FitWarning warning;
    warning.code = geometry::notice::kSkinOverLine;
    warning.line = line.name;
    warning.value = deepest(worn);
    std::vector<Eigen::Vector3d> feet;
    for (std::size_t i = 0; i < worn.feet.size(); ++i)
      if (-worn.heights[i] > usual) feet.push_back(worn.feet[i]);
    take_place(triangles_below(worn, feet, skin.triangles, skin.worn, kHeldSkin), skin, warning);
    all.push_back(std::move(warning));
  }
  return all;
}

}  // namespace tensegric_fit::tffd
