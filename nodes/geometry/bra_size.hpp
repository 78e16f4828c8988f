/// Bra sizes of EN 13402-3.
#pragma once

#include <optional>
#include <string>

namespace tensegric_fit::geometry {

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

}  // namespace tensegric_fit::geometry
