/// Skin that has passed through skin.
#pragma once

#include <utility>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::stability {

/// Skin that lies inside the body.
struct SkinInside {
  std::vector<int> vertices;  ///< of one connected patch, ascending
  std::vector<double>
      depths;  ///< m, of each: to the nearest skin that is not the patch's, or where the skin crosses
};

/// Patches of vertices inside a closed mesh, that is, behind its skin elsewhere, connected to corners of its
/// `pairs` that cross. By the solid angle that the mesh fills round each (A. van Oosterom, J. Strackee, IEEE
/// Trans. Biomed. Eng. 30, 1983), 10 micrometres outside its own skin.
std::vector<SkinInside> skin_inside(const geometry::TriangleMesh& mesh,
                                    const std::vector<std::pair<int, int>>& pairs);

}  // namespace tensegric_fit::stability
