/// A first answer to a garment, found on a coarse control mesh within milliseconds, for the nodes of a fine
/// one.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tensegric/garment_fitter.hpp"

namespace tensegric_fit::tensegric {

/// For one thread.
class CoarseFitter {
 public:
  /// `fine`: of the fitter whose answers follow. The coarse mesh has the default tissue, which is calibrated
  /// on coarse meshes, with the same stiff parts, solver, posture and kept volume.
  CoarseFitter(const FitterOptions& fine, BindBody bind_body);

  /// The next garments are worn on these two meshes of one body. \throw Refusal as GarmentFitter::take: there
  /// are no answers then until meshes are taken
  void take(const geometry::ControlMesh& coarse, const geometry::ControlMesh& fine,
            const geometry::BodyMeasures* measures, std::function<geometry::TriangleMesh()> body);

  struct Answer {
    Iterate state;                              ///< of the coarse mesh
    std::vector<Eigen::Vector3d> outer, inner;  ///< nodes of the fine mesh, carried by the coarse one
    int triangles;                              ///< of the coarse mesh
  };
  /// `newtons`: Model::newtons of the fine mesh, which the garment's pseudo forces are of. Nothing where
  /// `go_on` stopped it, no balance was found, or no meshes are taken. \throw Refusal as GarmentFitter::fit
  std::optional<Answer> fit(Garment garment, double newtons, SolverName solver, int rest,
                            const std::function<bool()>& go_on);

 private:
  const BindBody bind_body_;
  const geometry::Posture posture_;
  const double beta_;
  GarmentFitter fitter_;
  geometry::ControlMesh fine_;
  geometry::BoneFrames bones_;
  std::unique_ptr<const BodyUnderGarment> skin_;  // fine_'s outer nodes, bound to the coarse mesh
};

}  // namespace tensegric_fit::tensegric
