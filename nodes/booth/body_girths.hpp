/// Heights and girths of the parametric body, from its own mesh.
#pragma once

#include <string>
#include <vector>

#include "booth/body_shape.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::booth {

/// Adds heights, girths and their loops to `measures`, which holds the landmarks, in the body frame; returns
/// how the waist was chosen. Girths are hull perimeters of horizontal sections without the arms. bust: all
/// loops of the trunk at the mean height of the bust points; underbust: the trunk's loop 3 mm below the
/// lowest fold; waist: interior minimum between hip + 100 mm and underbust - 15 mm, 5 mm or more below both
/// ends, else the navel's level; hip: mean height of the buttock points; neck: in the plane across the neck's
/// axis; upper arm and thigh across their axes, 87 mm below the axilla and 66 mm below the crotch at a
/// stature of 1.70 m.
std::string measure_girths(const BodyShape& shape, const geometry::TriangleMesh& mesh,
                           geometry::BodyMeasures& measures);

}  // namespace tensegric_fit::booth
