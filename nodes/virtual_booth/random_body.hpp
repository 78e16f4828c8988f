/// Customers and booths drawn at random: no two alike, each known exactly.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "virtual_body/model_body.hpp"
#include "virtual_body/virtual_body.hpp"
#include "virtual_booth/virtual_scanner.hpp"

namespace tensegric_fit::virtual_booth {

/// Where bodies come from (README).
enum class Family { model, implicit };
const std::vector<std::string>& families();  ///< their names, in the order of the enumeration
/// \throw Refusal bad_option: no such family
Family family_named(const std::string& name);

/// A customer of that family; of the model's, she whom random_model_body draws. Same arguments, same bits.
/// \throw Refusal broken_file: the body model cannot be read
virtual_body::VirtualBody random_customer(Family family, std::uint64_t seed);

/// Implicit. Drawn from the spans of women of 20 to 80: stature 1.50 to 1.80 m, bust girth 0.78 to 1.30 m,
/// firm to hanging breasts, arms 15 to 80 degrees from the vertical, some stooped, turned or tilted. Same
/// seed, same body. The body can be made.
virtual_body::BodyParameters random_body(std::uint64_t seed);

/// A woman of the model: shape coefficients from the standard normal distribution, none beyond 2.5;
/// stature 1.50 to 1.80 m; arms 10 to 60 degrees from hanging, legs slightly apart, wider where limbs would
/// run into each other; a small lean, bend and twist; not turned or tilted. Same arguments, same woman. The
/// body can be made: who cannot be is drawn again. \throw Refusal of make_body: none of twenty draws can be
virtual_body::ModelBodyParameters random_model_body(std::uint64_t seed, const body_model::Model& model);

/// Eight to twelve sensors, 40,000 to 250,000 points; noise 0.5 to 1.5 mm, columns up to about 2 mm off,
/// outliers to 0.5 %; on some floor, frame, hair, black underwear, or a fracture of 5 to 15 mm at an
/// underarm. A body that leans is scanned in a frame that leans, floor and all. Same arguments, same options.
ScannerOptions random_scanner(std::uint64_t seed, const virtual_body::VirtualBody& body);

}  // namespace tensegric_fit::virtual_booth
