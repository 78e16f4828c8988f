#include "tffd/garment_check.hpp"

#include <iterator>

namespace tensegric_fit::tffd {

std::vector<geometry::FitWarning> check_garment(const std::vector<Eigen::Vector3d>& scanned,
                                                const WornSkin& skin, const std::vector<WornLine>& lines,
                                                const HoldOptions& options) {
  std::vector<geometry::FitWarning> all = check_skin(skin, lines);
  std::vector<geometry::FitWarning> loose =
      under_constricted({scanned, skin.worn, skin.triangles}, lines, options);
  all.insert(all.end(), std::make_move_iterator(loose.begin()), std::make_move_iterator(loose.end()));
  return all;
}

}  // namespace tensegric_fit::tffd
