/// How far a girth can be off because of noise, its level and skin that the scan did not see.
#pragma once

#include <functional>
#include <vector>

#include "landmarks/body_shape.hpp"

namespace tensegric_fit::landmarks {

using Tape = std::vector<Eigen::Vector3d>;

/// The tape round the limb or neck in a plane parallel to that of `tape`, `offset` metres along its normal;
/// empty where no section closes there. \pre at least three points
Tape parallel_tape(const BodyShape& body, const Tape& tape, double offset);

/// Half-width in metres of the 95 % interval of the length of `tape_at(0)`: twice the deviation of the tapes
/// up to 2.5 mm below and above it, which noise and the level's own uncertainty make, and what fillings that
/// lie 5 mm too deep or too high would change. `tape_at` gives the tape at an offset, empty where there is
/// none.
double half_width_of(const BodyShape& body, const std::function<Tape(double)>& tape_at);

}  // namespace tensegric_fit::landmarks
