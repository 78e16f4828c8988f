/// Robust Gauss-Newton over pose and shape with Gaussian priors: one scale of distances after the other.
#pragma once

#include "body_model/matching.hpp"
#include "body_model/posed_model.hpp"

namespace tensegric_fit::body_model {

/// A part of the way, coarse to fine.
struct Stage {
  double from, to;  ///< m, scale of distances in the first and the last iteration
  int iterations;   ///< two at least
  int every;        ///< n-th fit point takes part
  int samples;      ///< that look for the model in their turn
  int components;   ///< of the shape that are free
};

struct Fitted {
  Parameters parameters;
  Matching matching;  ///< of the last iteration, with the fit points that took part
  double surprise;    ///< minus the logarithm of its probability, but for a constant: samples and prior,
                      ///< whatever of the model they lack
};

/// \pre samples in random order
Fitted fit_stage(const Model& model, const Matcher& matcher, Parameters start, const Stage& stage);

}  // namespace tensegric_fit::body_model
