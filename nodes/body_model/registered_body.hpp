/// The model on a person: what other stages know of where things are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "body_model/posed_model.hpp"

namespace tensegric_fit::body_model {

/// What speaks for and against a person.
struct Evidence {
  double misfit =
      0;  ///< m: of surface and skin by shape and pose alone, on average, where the surface is hers
  double unexplained = 0;  ///< share of the surface that is not, 0 to 1
  double shape = 0;        ///< root of the mean square of the shape's coefficients, in standard deviations
};

/// Surface that is not hers: hair, a thing, somebody else. Scan's frame, metres.
struct Unexplained {
  Eigen::Vector3d centre;
  double extent;        ///< between its farthest points
  double share;         ///< of the whole surface, 0 to 1
  std::string reason;   ///< where it is and what it may be, in words
  bool person = false;  ///< beside her, and as large as somebody else would be
};

/// In the scan's frame, metres; per-vertex arrays have one entry per vertex of the model's skin.
struct RegisteredBody {
  std::shared_ptr<const Model> model;
  Parameters parameters;
  double residual = 0;  ///< m: mean distance of model and surface from each other before the displacement,
                        ///< each capped at Matching::kUnmatched, without parts that are not there and
                        ///< `unexplained` things
  std::vector<Eigen::Vector3d> posed;  ///< skin by pose and shape alone
  std::vector<Eigen::Vector3d> skin;   ///< and displaced onto the surface
  std::vector<double> off;      ///< m, of the skin from the surface; Matching::kUnmatched where there is none
  std::vector<double> support;  ///< m, of the skin from the middle of the samples nearest to it: small where
                                ///< they lie all round; where the mesh of a scan lost it, from that mesh
  std::vector<double> there;    ///< of each part, the share of its skin that has samples; empty: not counted
  std::vector<Eigen::Vector3d> joints;  ///< one per bone
  std::vector<Eigen::Vector3d> bone_points;
  Evidence evidence;
  std::vector<Unexplained> unexplained;  ///< largest first
  std::string note;                      ///< what is unusual about her shape, in words, or empty
  bool scanned = true;  ///< registered to a scan's points or mesh; false: to a mesh that was given
  Eigen::Vector3d vertical = Eigen::Vector3d::UnitZ();  ///< up, unit vector
  double ground = 0;                                    ///< m along `vertical`, under her soles
  /// m, of `ground`: 0 where a floor was seen, and of a given mesh whose lowest place is that of its feet
  double ground_deviation = 0;

  /// \throw std::out_of_range: the model has no such point
  Eigen::Vector3d skin_point(const std::string& name) const;
  Eigen::Vector3d posed_point(const std::string& name) const;  ///< the same by pose and shape alone
  Eigen::Vector3d bone_point(const std::string& name) const;
  Eigen::Vector3d joint(const std::string& name) const;
  /// Her left and the pelvis' up, unit vectors.
  Eigen::Vector3d left() const { return parameters.rotation.col(0); }
  Eigen::Vector3d up() const { return parameters.rotation.col(2); }
  double stature() const;  ///< m, of the model in this size, standing straight
};

/// A named point of the skin; `skin`: the model's vertices in any pose, others may follow. \throw
/// std::out_of_range: there is none of that name
Eigen::Vector3d skin_point(const Model& model, const std::vector<Eigen::Vector3d>& skin,
                           const std::string& name);

/// The same in another frame.
RegisteredBody moved(const RegisteredBody& body, const Eigen::Isometry3d& motion);

}  // namespace tensegric_fit::body_model
