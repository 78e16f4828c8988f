/// A second scan of a body, with the garment on, as a reference: it says where the skin is, not which point
/// of it went where (P2 §6).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "correlation/distance_map.hpp"
#include "fit/chain.hpp"

namespace tensegric_fit::calibration {

/// Metres, the frame of the bare body.
class WornReference {
 public:
  /// Lays the worn scan onto the bare body by the skin that no garment covers. `control`: of the garment's
  /// regions on the bare body; `cloth`: thickness of the garment. \throw Refusal as correlation::correlate;
  /// too_few_data: fewer than 100 covered vertices are seen
  WornReference(const fit::Body& bare, const geometry::ControlMesh& control, fit::Body worn, double cloth);

  /// Of each covered vertex that the worn scan shows, where it is in `deformed`, the signed distance to the
  /// worn skin, m; 0 where no skin there faces alike.
  std::vector<double> distances(const fit::Body& bare, const std::vector<Eigen::Vector3d>& deformed) const;

  std::size_t vertices() const { return covered_.size(); }

 private:
  struct Worn {
    explicit Worn(fit::Body worn);
    fit::Body body;
    correlation::SeenSurface surface;
  };

  std::shared_ptr<const Worn> worn_;  // shared by copies: cases are copied per density
  geometry::TriangleMesh control_;
  double cloth_;
  Eigen::Isometry3d bare_from_worn_;
  std::vector<correlation::SkinPart> parts_;  // covered, or mobile: not compared
  std::vector<int> covered_;
};

}  // namespace tensegric_fit::calibration
