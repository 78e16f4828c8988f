/// Horizontal sections from soles to crown, with the trunk and the two legs told from the rest.
#pragma once

#include <array>
#include <vector>

#include "landmarks/sliced_mesh.hpp"

namespace tensegric_fit::landmarks {

/// One height. `trunk` and `legs` are indices into `outlines`, -1 where there is none; trunk goes on as neck
/// and head.
struct Level {
  double height;
  std::vector<Outline> outlines;
  int trunk = -1;
  std::array<int, 2> legs{-1, -1};
};

struct BodyLevels {
  std::vector<Level> levels;  ///< evenly spaced, lowest first
  double step;                ///< metres between two
  double
      legs_part;   ///< height under which the two legs are apart: the crotch, or below it where thighs touch
  double stature;  ///< top of the head; estimated from the legs where there is no head
  bool has_head;

  /// The two legs just below `legs_part`.
  const Level& parted() const { return levels[nearest(legs_part)]; }

  /// Index of the level nearest to a height.
  int nearest(double height) const;
};

/// \throw Refusal not_a_body, wrong_unit, missing_part:legs
BodyLevels find_levels(const SlicedMesh& body);

}  // namespace tensegric_fit::landmarks
