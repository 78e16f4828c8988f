/// What a status says about the shape of a deformed control mesh.
#pragma once

#include <string>
#include <vector>

#include "tensegric/model.hpp"

namespace tensegric_fit::tensegric {

/// The sentence on a shape over which skin is turned over.
inline constexpr char kSkinTurnsOver[] =
    "Skin turns over: the shape is not to be trusted; loosen the garment.";

/// How many control triangles were compressed below half their area, and how many turned over: by more than
/// 90 degrees where bones hold the inner nodes, against the next triangle by more than 120 where nothing
/// does.
struct TriangleChange {
  int below_half = 0, turned_over = 0;
};

TriangleChange triangle_change(const Model& model, const Positions& x);

/// Sentences on triangles that are compressed below half their area or turned over; empty where there are
/// none.
std::string shape_note(const Model& model, const Positions& x);

}  // namespace tensegric_fit::tensegric
