/// What a fit warns of, and what of a body is missing, as sentences for a clerk: what is wrong, where, and
/// what she can do.
#pragma once

#include <string>

#include "geometry/body_measures.hpp"
#include "geometry/fit_warning.hpp"

namespace tensegric_fit::inspect::words {

/// The landmark that is nearest to a point of the scan; null where there is none.
const geometry::Landmark* nearest_landmark(const geometry::BodyMeasures& measures,
                                           const Eigen::Vector3d& point);

/// "3 cm below the left bust point", "at the navel"; empty where the body has no landmarks.
std::string place(const geometry::BodyMeasures& measures, const Eigen::Vector3d& point);

/// "The skin folds into a shelf 3 cm below the left bust point: 8 cm2 are turned by up to 71 degrees. Loosen
/// 'chest'."
std::string warning(const geometry::FitWarning& warning, const geometry::BodyMeasures& measures);

/// "Missing: left forearm, right hand", of parts of the body; of many the first, and how many more. Empty if
/// none is missing.
std::string missing(const geometry::BodyMeasures& measures);

/// The text with names of parts and landmarks in spoken words: "left forearm" for "forearm_L", "top of the
/// head" for "crown".
std::string with_names_spoken(const std::string& words);

}  // namespace tensegric_fit::inspect::words
