/// Where skin passes through skin.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::stability {

/// Whether two triangles without a common corner cross: an edge of one goes through the inside of the other.
/// Triangles in one plane do not cross, nor do those that only touch.
bool cross(const std::array<Eigen::Vector3d, 3>& one, const std::array<Eigen::Vector3d, 3>& other);

/// Pairs of triangles without a common corner that cross, of which at least one has a `looked_at` vertex; in
/// ascending order, the lower number first. \pre one flag a vertex
std::vector<std::pair<int, int>> crossings(const geometry::TriangleMesh& mesh,
                                           const std::vector<char>& looked_at);

/// Skin that lies inside the body.
struct SkinInside {
  std::vector<int> vertices;   ///< of one connected patch, ascending
  std::vector<double> depths;  ///< m, of each: to the nearest skin that is not the patch's, or where the skin crosses
};

/// Patches of vertices inside a closed mesh, that is, behind its skin elsewhere, connected to corners of the
/// crossing pairs. By the solid angle that the mesh fills round each (A. van Oosterom, J. Strackee, IEEE
/// Trans. Biomed. Eng. 30, 1983), 10 micrometres outside its own skin.
std::vector<SkinInside> skin_inside(const geometry::TriangleMesh& mesh,
                                    const std::vector<std::pair<int, int>>& pairs);

}  // namespace tensegric_fit::stability
