/// The fold under a breast as an arc, where parts of it lie in a pocket that no sensor sees.
#pragma once

#include <vector>

namespace tensegric_fit::landmarks {

/// A place of the fold, on one of the profiles side by side.
struct FoldPlace {
  double medial;      ///< metres from the bust point's profile towards the middle of the chest
  double height;      ///< metres
  double hollowness;  ///< 1/m
  double opening;     ///< radians between the breast's underside and the chest below; negative: not known
};

/// Height of the lowest point, from the bust point's profile to `reach` metres medial, of the arc through a
/// fold: one profile that noise or a filling spoils does not tell it. \pre `fold` has a place.
double lowest_of_arc(const std::vector<FoldPlace>& fold, double reach);

/// How far above `lowest` (metres) the lowest point of the fold between the bust point and `reach` metres
/// medial is, by the arc through those of its places that open wide enough to be seen; 0 where they do not
/// tell. Between walls that are closer a reconstruction spans the pocket's mouth, below the fold. `way` runs
/// from the outside to the middle.
double fold_above_pocket(const std::vector<FoldPlace>& way, double lowest, double reach);

/// Whether most of the fold within reach lies between walls that are too close to see far into.
bool lies_in_pocket(const std::vector<FoldPlace>& way, double reach);

}  // namespace tensegric_fit::landmarks
