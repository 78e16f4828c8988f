/// How hard a band presses (Laplace's law along its fibres).
#pragma once

#include "tensegric/band.hpp"

namespace tensegric_fit::tensegric {

/// Largest normal pressure of a band that pulls with `newtons`, Pa: pull / width times the curvature of its
/// fibres into the body. A fibre's part of the pull and of the width are the same, so that its share cancels.
/// 0 of a line without width.
double largest_pressure(const Model& model, const Band& band, const Positions& x, double newtons);

}  // namespace tensegric_fit::tensegric
