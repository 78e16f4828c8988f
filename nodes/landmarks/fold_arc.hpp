/// The fold under a breast as an arc, where parts of it lie in a pocket that no sensor sees.
#pragma once

#include <vector>

namespace tensegric_fit::landmarks {

/// A place of the fold, on one of the profiles side by side.
struct FoldPlace {
  double medial;   ///< metres from the bust point's profile towards the middle of the chest
  double height;   ///< metres
  double opening;  ///< radians between the breast's underside and the chest below; negative: not known
};

/// Height of the lowest point, from the bust point's profile to `reach` metres medial, of the arc through a
/// fold: one profile that noise or a filling spoils does not tell it. \pre `fold` has a place.
double lowest_of_arc(const std::vector<FoldPlace>& fold, double reach);

/// Whether most of the fold within reach lies between walls that are too close to see far into.
bool lies_in_pocket(const std::vector<FoldPlace>& way, double reach);

}  // namespace tensegric_fit::landmarks
