/// The registered body model, drawn over the body that it is registered to.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "inspect/colours.hpp"
#include "inspect/strokes.hpp"

namespace tensegric_fit::inspect {

/// A body model's skin on a person, in the scan's frame, metres.
struct ModelSkin {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 4>> quads;  ///< counter-clockwise from outside
  std::vector<unsigned char> part;        ///< one per vertex, index into parts
  std::vector<std::string> parts;         ///< names, as trunk, breast_L
};

/// \throw Refusal bad_model: a quad's vertex or a vertex' part that is not there; non_finite
void check_model_skin(const ModelSkin& skin);

/// One per part; left and right of a pair are shades of one colour, the left one (hers) darker.
std::vector<Colour> part_colours(const std::vector<std::string>& parts);

/// Neutral skin with a tint of its part's colour. `parts_of_skin`: one per vertex, index into parts; any
/// other number: neutral.
std::vector<Colour> tinted_skin(const std::vector<unsigned char>& parts_of_skin,
                                const std::vector<std::string>& parts);

/// Triangles of the skin, two per quad.
std::vector<Eigen::Vector3i> triangles_of(const ModelSkin& skin);

/// The edges of its quads over the vertices at `vertices`, a line each, in the colours of the parts.
std::vector<Stroke> model_strokes(const ModelSkin& skin, const std::vector<Eigen::Vector3d>& vertices);

}  // namespace tensegric_fit::inspect
