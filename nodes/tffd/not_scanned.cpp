#include "tffd/not_scanned.hpp"

#include "geometry/status.hpp"
#include "tffd/line_over_skin.hpp"
#include "tffd/under_constriction.hpp"

namespace tensegric_fit::tffd {

std::vector<geometry::FitWarning> not_scanned(const WornSkin& skin, const std::vector<char>& filled,
                                              const std::vector<WornLine>& lines) {
  if (skin.worn.size() != skin.rest.size() || (!filled.empty() && filled.size() != skin.rest.size()))
    throw geometry::Refusal(geometry::refusal::kBadMesh,
                            "skin check: not one worn place, or not one flag, per vertex");
  std::vector<geometry::FitWarning> all;
  if (filled.empty()) return all;
  for (const WornLine& line : lines) {
    const LineOverSkin lie = line_over_skin(line.at_rest, skin.triangles, skin.rest);
    std::vector<Eigen::Vector3d> feet;
    for (std::size_t i = 0; i < lie.feet.size(); ++i) {
      const Eigen::Vector3i& t = skin.triangles[lie.below[i]];
      if (filled[t[0]] + filled[t[1]] + filled[t[2]] > 1) feet.push_back(lie.feet[i]);
    }
    const double share =
        lie.feet.empty() ? 0 : static_cast<double>(feet.size()) / static_cast<double>(lie.feet.size());
    if (share <= kMostlyNotScanned) continue;
    geometry::FitWarning warning;
    warning.code = geometry::notice::kNotScanned;
    warning.line = line.name;
    warning.value = share;
    take_place(triangles_below(lie, feet, skin.triangles, skin.rest, kHeldSkin), skin, warning);
    all.push_back(std::move(warning));
  }
  return all;
}

}  // namespace tensegric_fit::tffd
