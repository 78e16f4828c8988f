/// The front of the neck in the middle of the body: where chin and neck meet, and where the throat is
/// deepest.
#pragma once

#include "landmarks/neck_plane.hpp"
#include "landmarks/profile.hpp"

namespace tensegric_fit::landmarks {

struct ThroatProfile {
  Profile profile;  ///< chin, neck and chest, from top to bottom
  int corner;       ///< the point where chin and neck meet; -1: they make no corner
  int deepest;      ///< the point where the throat stops receding; -1: not seen

  /// The point so many metres along the skin below that one, or the profile's end.
  const Eigen::Vector3d& along(int from, double length) const;
};

/// \param thinnest the neck's thinnest loop
ThroatProfile find_throat(const BodyShape& body, const NeckPlane& thinnest);

}  // namespace tensegric_fit::landmarks
