/// Where an assumed bone lies below a control mesh (no scan sees bones).
#pragma once

#include <string>

namespace tensegric_fit::control_mesh {

/// What is known of the surface is where the rim and skin over bone lie; elsewhere it bends least.
struct BoneRule {
  double inset;  ///< m that it lies below the skin there
  double least;  ///< m of tissue over it anywhere, at least
  double share;  ///< of the way there that the units reach down
};

/// Tissue that is deepest at a node and its mirror image: depth + more * min(1, sum over them of
/// exp(-(distance / reach)^2 / 2))
/// * (1 - exp(-(distance to their mid-plane / cleft)^2 / 2)). The assumption of the finite-element hips.
struct CushionRule {
  double depth, more, reach, cleft;  ///< m
  double share;                      ///< of the depth that the units reach down
  std::string at;                    ///< the left of the two nodes
};

}  // namespace tensegric_fit::control_mesh
