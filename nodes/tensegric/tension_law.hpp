/// What a garment line pulls at which length (README.md, Lines and bands).
#pragma once

#include "tensegric/garment.hpp"

namespace tensegric_fit::tensegric {

/// Rigid, or so stiff that its length is better had from its tension than the other way round.
bool is_steep(const TensionLaw& law);

/// Tension of an elastic law, its slope by stretch, and its integral over stretch from 1. Beyond a table's
/// last row the last slope goes on. \pre the law is not rigid
double law_tension(const TensionLaw& law, double stretch);
double law_slope(const TensionLaw& law, double stretch);
double law_work(const TensionLaw& law, double stretch);

/// The other way round, for a steep law: stretch by tension, its slope, and the integral of the tension over
/// the stretch up to that tension. A rigid law has stretch 1. Defined for a tension below zero too, which a
/// solver may pass through.
double law_stretch(const TensionLaw& law, double tension);
double law_compliance(const TensionLaw& law, double tension);
double law_work_by_tension(const TensionLaw& law, double tension);

}  // namespace tensegric_fit::tensegric
