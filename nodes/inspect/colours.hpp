/// Colours of the deformed skin, and light baked into colours.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::inspect {

using Colour = std::array<std::uint8_t, 3>;  ///< RGB

/// One neutral colour for an undeformed body.
inline constexpr Colour kNeutral{212, 205, 199};

/// Landmarks and tapes: sure, and with a confidence below 0.5.
inline constexpr Colour kSureColour{40, 110, 220}, kUnsureColour{240, 140, 20};

/// Skin that there is a warning of.
inline constexpr Colour kWarnedColour{240, 140, 20};

/// Skin that a garment does not reach or hold.
inline constexpr Colour kUnheldColour{40, 150, 90};

/// The scale's ends: distortion below the first and above the second is shown as the end is.
inline constexpr double kTightest = 0.7, kLoosest = 1.3;

/// Between the two, 0 to 1.
Colour mixed(const Colour& from, const Colour& to, double share);

/// Those vertices half in kUnheldColour, so that what is under it still shows. \pre in range
std::vector<Colour> with_unheld(std::vector<Colour> colours, const std::vector<int>& unheld);

/// Fixed scale, even to the eye: distortion 1 is neutral, less (pressed together) goes to red, more to blue.
Colour distortion_colour(double distortion);

/// The same for many; a value that is not finite is neutral.
std::vector<Colour> distortion_colours(const std::vector<double>& distortion);

/// The scale under it: -1 is the tight end, 0 neutral, 1 the loose end. \pre finite
Colour two_sided_colour(double share);

/// Fixed scale of distances between two surfaces: kFarthestDistance and more inside is red, outside blue.
inline constexpr double kFarthestDistance = 0.010;  ///< m
/// Grey where `compared` is false.
Colour distance_colour(double metres, bool compared);

/// From neutral at 0 to violet at 1: how far something went. \pre finite
Colour way_colour(double share);

/// Pull of a garment line, from yellow to brown on one fixed scale for all fits. Grey where it is no number.
Colour tension_colour(double tension);

/// Force in a member over the mean pull at rest: grey without force, or where that is no number, red where it
/// pulls, blue where it is pressed.
Colour member_colour(double force);

/// The same colours with a light baked in: rviz draws coloured triangle lists unlit. `light_direction` is the
/// way the light shines. It is soft: surfaces fade all the way to the side that faces away, and nothing is
/// black. \pre one colour a vertex
std::vector<Colour> lit(const geometry::TriangleMesh& mesh, const std::vector<Colour>& colours,
                        const Eigen::Vector3d& light_direction);

}  // namespace tensegric_fit::inspect
