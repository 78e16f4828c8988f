/// The pictures that `fit` writes, as PNG files.
#pragma once

#include <string>
#include <vector>

#include "fit/chain.hpp"
#include "geometry/fit_warning.hpp"

namespace tensegric_fit::fit {

struct PictureFile {
  std::string name, png;
};

/// What of a body its pictures show beside the garment.
struct PictureWishes {
  bool measured = true;  ///< with the tapes of its girths; a shape has none
  bool overlay = false;  ///< and the registered body model over it
};

/// Front, side, distortion, and back where a garment is worn behind; made at the same time.
std::vector<PictureFile> pictures_of(const Body& body, const Fitting& fitting, const Fit& fit,
                                     const std::vector<geometry::FitWarning>& warnings,
                                     const PictureWishes& wishes);

/// Of a body without a garment: front and side.
std::vector<PictureFile> pictures_of(const Body& body, const PictureWishes& wishes);

}  // namespace tensegric_fit::fit
