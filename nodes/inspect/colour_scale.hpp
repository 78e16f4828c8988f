/// What the colours of a body mean: the quantity, its range, and the words beside the legend.
#pragma once

#include <string>
#include <vector>

#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {

/// Distortion: skin area after / before (P1 Fig. 8). Stretch: the principal stretch of the skin that is
/// farther from 1. Displacement: how far the skin went, metres. Plain: one neutral colour.
enum class ColourBy { distortion, stretch, displacement, plain };

/// Skin area below which a garment constricts too much, after / before (P1 Fig. 8), and its reciprocal, above
/// which it stretches too much.
inline constexpr double kOverConstricted = 0.8, kOverStretched = 1 / kOverConstricted;

/// `neutral` is drawn in kNeutral, `low` and `high` in the colours of the ends.
struct ColourScale {
  ColourBy by;
  double low, neutral, high;
};

/// The same for every body.
ColourScale fixed_scale(ColourBy by);

/// As wide as the values ask for: ends that are equally far from neutral, which stays where it is, but none
/// below 0. Never narrower than 1 per cent or 1 mm, so that an undeformed body stays neutral. \pre finite
/// values
ColourScale auto_scale(ColourBy by, const std::vector<double>& values);

/// A value that is not finite is neutral.
Colour colour_of(const ColourScale& scale, double value);
std::vector<Colour> colours_of(const ColourScale& scale, const std::vector<double>& values);

/// A value as a person reads it: "93 %", "12 mm".
std::string words_of(ColourBy by, double value);

}  // namespace tensegric_fit::inspect
