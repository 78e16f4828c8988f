/// The papers' solvers: strut by strut, with pseudo forces of volume and lines (P1 §3.1, §3.4-3.5; P2 §5).
#pragma once

#include "tensegric/problem.hpp"

namespace tensegric_fit::tensegric {

/// `adaptive`: the volume force is held back while the line force is the greater (P2 §5).
Outcome relax(const Problem& problem, const Solution* start, bool adaptive, Recorder& recorder);

}  // namespace tensegric_fit::tensegric
