/// Needle-shaped triangles of the body, and how they are kept from turning over.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "tffd/reach.hpp"

namespace tensegric_fit::tffd {

/// A vertex that moves with the foot of its triangle's height on the longest side, from + part (to - from).
struct Tie {
  int vertex;
  int from, to;
  double part;
};

/// A triangle whose height is a hundredth of its side turns over as soon as the skin's motion bends by that
/// much between its corners, however smooth the motion is and though nothing folds. So in every triangle
/// with a height below a twentieth of its longest side, the corner over that side is tied to it where one
/// of its ends is anchored. The narrowest come first; a vertex is tied once, and one that carries another is
/// not tied. Tied vertices become anchors with the shares of their feet.
std::vector<Tie> tie_needles(const geometry::TriangleMesh& body, std::vector<Anchor>& anchors);

}  // namespace tensegric_fit::tffd
