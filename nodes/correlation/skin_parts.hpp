/// What each part of the skin is to the comparison of a simulated body with a worn scan.
#pragma once

#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::correlation {

/// A body that a garment was simulated on. Only borrowed, but for the flags. Metres, one scan's frame.
struct SimulatedBody {
  const geometry::TriangleMesh& rest;
  const std::vector<Eigen::Vector3d>& deformed;  ///< one per vertex of `rest`
  const geometry::TriangleMesh& control;         ///< outer nodes of the control mesh, at rest
  const geometry::BodyMeasures& measures;        ///< of `rest`
  std::vector<char> filled = {};  ///< empty, or one flag per vertex: 1 where its scan saw nothing

  bool is_seen(std::size_t vertex) const { return filled.empty() || filled[vertex] == 0; }
};

/// \throw Refusal bad_mesh, non_finite: meshes that are not valid, another number of vertices at rest and
/// deformed, or of flags
void check(const SimulatedBody& body);

/// covered: under the fitted regions: the nearest place of the control mesh at rest lies within its border,
/// no more than kUnderControl away, and faces as the skin does within 60 degrees. It is taken to wear the
/// garment. surroundings: skin of the trunk within kSurroundings of what is covered. still: the rest of the
/// trunk that the scan saw, which stays as it is under a garment. mobile: arms, hands, head and legs, which
/// never stand twice alike, and fillings of the trunk; not compared.
enum class SkinPart : char { covered, surroundings, still, mobile };

inline constexpr double kAlike = 0.5;          ///< cosine between the normals of surfaces that face alike
inline constexpr double kUnderControl = 0.03;  ///< m; between its nodes a control mesh lies below the skin
inline constexpr double kSurroundings = 0.04;  ///< m; t-FFD moves nothing there, but tissue and seams do

/// One per vertex. The trunk reaches from the thighs, a seventh of the crotch's height below it, to the
/// shoulders, and sideways to the armpits: what is farther out are arms and hands, or the outer hips.
/// \throw Refusal missing_part: a landmark that bounds the trunk was not found
std::vector<SkinPart> parts_of(const SimulatedBody& body);

/// Pieces that keep their shape when a person stands otherwise: chest above the underbust, pelvis below the
/// hip with the upper thighs, and the lower legs. Vertices that the scan saw, ascending; none covered or near
/// it. Empty where the level that bounds a piece was not found.
struct Pieces {
  std::vector<int> chest, pelvis, left_shank, right_shank;
};

/// \throw Refusal as parts_of
Pieces pieces_of(const SimulatedBody& body, const std::vector<SkinPart>& parts);

}  // namespace tensegric_fit::correlation
