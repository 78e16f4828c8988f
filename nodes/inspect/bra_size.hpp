/// Bra sizes of EN 13402-3.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/body_measures.hpp"

namespace tensegric_fit::inspect {

/// A size as it stands on a label: "75B" is band 75, cup "B".
struct BraSize {
  int band;  ///< underbust girth in cm, to the nearest multiple of 5; half-way is the larger one
  std::string
      cup;  ///< bust girth less underbust girth: AA over 10 to 12 cm, A to 14, B to 16, each 2 cm more

  std::string label() const { return std::to_string(band) + cup; }
};

/// From girths in metres. Nothing where there is no such size: a band below 60 or above 140, a difference of
/// 10 cm or less, or of more than the letter Z stands for (64 cm).
std::optional<BraSize> bra_size(double bust, double underbust);

/// A size is worth naming beside the measured one where girths as uncertain as hers have it this often, or
/// the measured one less often than `kInDoubt`: many sizes may share what is left, each of them seldom.
inline constexpr double kOnABorder = 0.25, kInDoubt = 0.5;

/// The size by the measured girths and, where she lies on a border or the girths leave several open, the
/// likeliest other. The girths' errors are taken as independent and normal; half-widths are those of their 95
/// % intervals, 0: exact. Metres. Empty where the measured girths have no size, or one of them is
/// unsure.
std::vector<BraSize> bra_sizes(const geometry::Measure& bust, const geometry::Measure& underbust);

}  // namespace tensegric_fit::inspect
