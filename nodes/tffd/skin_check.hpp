/// Where a garment asks more of the skin than smooth skin does (README.md).
#pragma once

#include <vector>

#include "geometry/fit_warning.hpp"
#include "tffd/skin_place.hpp"

namespace tensegric_fit::tffd {

// Definitions: by how much skin is turned, rad.
inline constexpr double kTurned = 45 * 3.14159265358979323846 / 180;
inline constexpr double kShelf = 60 * 3.14159265358979323846 / 180;
inline constexpr double kTurnedOver = 90 * 3.14159265358979323846 / 180;
/// Definition: skin of a finger's breadth squared counts, less does not. m^2
inline constexpr double kLeastPatch = 1e-4;
/// m^2: a triangle of the body mesh as it is by default (62,000 on 1.7 m^2). Less of a quantity may be one
/// needle's, so the largest value is the one that this much skin exceeds, and turned skin starts here.
inline constexpr double kGrain = 0.25e-4;
/// Skin strained by more than 60 % is held to be at risk of damage (M. Norris et al., BMJ Open Sport Exerc.
/// Med. 6, 2020, e000770); excised skin fails at 54 +- 17 % (A. Ni Annaidh et al., J. Mech. Behav. Biomed.
/// Mater. 5, 2012).
inline constexpr double kMostStretch = 1.6;
/// Skin that keeps its length and is pressed to this share of it stands up in folds of 60 degrees: cos 60.
inline constexpr double kLeastStretch = 0.5;

/// Connected places (by corners of triangles), the largest of a kind first:
/// `shelf`: skin turned by more than kTurned, where in all kLeastPatch or more is turned by more than kShelf;
///   one per place that has a tenth of that;
/// `turned_over`: kGrain and more turned by more than kTurnedOver, where there is a shelf;
/// `skin_turns`: where there is none, kLeastPatch turned by more than kTurned, or kGrain turned over;
/// `over_stretched`, `pressed_together`: kLeastPatch beyond kMostStretch, kLeastStretch.
/// Turns are of triangles' normals; only triangles with a corner that moved are looked at. Where there are
/// no lines nothing is said of turns: a force or a posture bends a shape as a whole.
/// \throw Refusal bad_mesh: not one worn place a vertex
std::vector<geometry::FitWarning> check_skin(const WornSkin& skin, const std::vector<WornLine>& lines);

/// Whether half of kGrain of skin and more, in all, is turned by more than kTurnedOver: no shape of skin.
/// Half: with it fits were measured. \pre as many worn places as vertices
bool turns_over(const WornSkin& skin);

}  // namespace tensegric_fit::tffd
