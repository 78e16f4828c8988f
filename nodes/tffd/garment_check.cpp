#include "tffd/garment_check.hpp"

#include <iterator>

#include "tffd/crossing_skin.hpp"

namespace tensegric_fit::tffd {

std::vector<geometry::FitWarning> check_garment(const std::vector<Eigen::Vector3d>& scanned,
                                                const WornSkin& skin, const std::vector<WornLine>& lines,
                                                const HoldOptions& options) {
  const WornSkin placed{skin.rest, skin.worn, skin.triangles, &scanned};
  std::vector<geometry::FitWarning> all = check_skin(placed, lines);
  const auto append = [&all](std::vector<geometry::FitWarning> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  append(check_crossings(placed, lines));
  append(under_constricted({scanned, skin.worn, skin.triangles}, lines, options));
  return all;
}

}  // namespace tensegric_fit::tffd
