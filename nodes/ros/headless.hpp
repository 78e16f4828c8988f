/// A fit that shows nobody's face.
#pragma once

#include "ros/fit_figures.hpp"

namespace tensegric_fit::node {

/// Body, deformed body and distortion end just above the tape of the neck, where they are closed; landmarks
/// above it are left out. Measures, the stature among them, stay as they are. \throw Refusal
/// missing_part:neck: it is not known where her head begins
FitFigures headless(FitFigures figures);

}  // namespace tensegric_fit::node
