#include "tffd/garment_check.hpp"

#include <iterator>

#include "tffd/crossing_skin.hpp"
#include "tffd/not_scanned.hpp"
#include "tffd/skin_over_line.hpp"

namespace tensegric_fit::tffd {

std::vector<geometry::FitWarning> check_garment(const ScannedSkin& scanned, const WornSkin& skin,
                                                const std::vector<WornLine>& lines,
                                                const HoldOptions& options) {
  const WornSkin placed{skin.rest, skin.worn, skin.triangles, &scanned.vertices};
  std::vector<geometry::FitWarning> all = check_skin(placed, lines);
  const auto append = [&all](std::vector<geometry::FitWarning> more) {
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  append(check_crossings(placed, lines));
  const WornSkin as_scanned{scanned.vertices, skin.worn, skin.triangles};
  append(under_constricted(as_scanned, lines, options));
  append(skin_over_lines(as_scanned, lines));
  append(not_scanned(as_scanned, scanned.filled, lines));
  return all;
}

}  // namespace tensegric_fit::tffd
