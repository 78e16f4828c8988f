/// Pictures of what came out of a case.
#pragma once

#include <string>
#include <vector>

#include "recording.hpp"

namespace tensegric_fit::regression {

struct CasePicture {
  std::string caption;
  std::string png;  ///< bytes of a PNG file
};

/// The body with its tapes; of the last garment before and after, and its distortion. What there is.
std::vector<CasePicture> pictures_of(const Recording& recording);

/// Whether there is a body under a garment.
bool has_fit(const Recording& recording);

/// The last garment's fit as the customer's page, with its 3D view and measures. \pre has_fit
std::string fit_page(const Recording& recording);

}  // namespace tensegric_fit::regression
