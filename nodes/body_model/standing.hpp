/// How a person stands: up, and the ground under her soles.
#pragma once

#include "body_model/registered_body.hpp"

namespace tensegric_fit::body_model {

/// What women who stand upright on level ground look like in a scan: fitted by
/// tests/body_model/fit_standing.py.
struct Standing {
  double forwards;         ///< rad: soles and legs of the model lean forwards by so much
  double legs_forwards;    ///< rad: the legs alone, where the feet are not there
  double sideways, along;  ///< rad: deviations of that lean, to the side and forwards, sway included
  double seen;             ///< m above the ground: the lowest points that sensors see of feet
  double soles;            ///< m above the ground: the model's soles, on average
  double ground;           ///< m: deviation of the ground that these two give
  /// m: the same where no foot is there, and where no thigh is either, and the model's soles alone say it
  double without_feet, without_thighs;
  /// rad: deviation of the line across the feet from that across the hips, about the vertical
  double facing;
};

/// \throw Refusal broken_file: not there, unknown keys, values out of range
Standing load_standing(const std::string& path);

/// The shipped one, loaded once. \throw Refusal broken_file
const Standing& shipped_standing();

/// How legs and soles stand: before what is known of other women is taken off.
struct Stance {
  Eigen::Vector3d up, forward;  ///< unit vectors, perpendicular to each other
  Eigen::Vector3d legs;         ///< up by the legs alone, a unit vector
  Eigen::Vector3d soles;        ///< m, their middle
};
Stance stance_of(const RegisteredBody& body);

/// Up, a unit vector: body.vertical, the booth's own, unless legs and soles clearly stand on another. Only
/// where both thighs and both shanks are there; where a foot is not, the legs alone say it.
Eigen::Vector3d upright(const RegisteredBody& body, const Standing& standing);

/// To her left, level, a unit vector: across her hips, and her feet as far as they stand side by side.
/// Shoulders turn with the arms.
Eigen::Vector3d across(const RegisteredBody& body, const Standing& standing);

/// From the line across her hips to that across her feet, about body.vertical, rad.
double turn_of_feet(const RegisteredBody& body);

/// The ground along body.vertical.
struct Ground {
  double height, deviation;  ///< m
};

/// By the model's soles alone: of both feet, or of the one that is there. The deviation is that of a body
/// without feet.
Ground ground_by_soles(const RegisteredBody& body, const Standing& standing);

/// Of the model's soles, along body.vertical, m.
double lowest_of_soles(const RegisteredBody& body);

/// By the lowest place of a mesh (`by_lowest`, m, with its `deviation`) where the soles of the model agree
/// with it; the farther they are apart, the more its deviation counts their distance, up to half of it, and
/// from 2 deviations of that distance on the ground goes towards the soles, from 3 on half of the way: the
/// lowest part of the feet may be missing. No cut of the feet makes heights jump.
Ground settled_ground(const RegisteredBody& body, double by_lowest, double deviation,
                      const Standing& standing);

/// From the model's soles and from the lowest points of a scan alike, as each is off on its own.
Ground ground_under(const RegisteredBody& body, const std::vector<Eigen::Vector3d>& points,
                    const Standing& standing);

}  // namespace tensegric_fit::body_model
