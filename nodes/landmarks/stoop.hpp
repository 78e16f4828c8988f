/// How far a body stoops.
#pragma once

#include "landmarks/neck.hpp"

namespace tensegric_fit::landmarks {

/// By how much the upper trunk is bent forward, radians: the lean of the back from the neck's back 0.12
/// statures down, less what it is on an upright body of such a neck. \pre neck.found
double stoop_of(const BodyShape& body, const Neck& neck);

}  // namespace tensegric_fit::landmarks
