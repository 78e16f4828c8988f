/// The body that a garment lies on, as far as this stage needs it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/fibre.hpp"
#include "geometry/posture.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/region_volume.hpp"

namespace tensegric_fit::tensegric {

/// For any thread.
class BodyUnderGarment {
 public:
  virtual ~BodyUnderGarment() = default;

  /// The garment's lines that lie on the body. \throw Refusal bad_garment: a point far from the skin;
  /// unknown_line: a node that the control mesh does not have
  virtual std::vector<geometry::LaidLine> lay(const Garment& garment) const = 0;

  /// One per region of the control mesh.
  virtual std::vector<PosedVolume> volumes() const = 0;

  /// A SkinFolds. \pre one place a node
  virtual bool folds(const std::vector<Eigen::Vector3d>& outer,
                     const std::vector<Eigen::Vector3d>& inner) const = 0;

  /// Where its vertices are with the control nodes here. \pre one place a node
  virtual std::vector<Eigen::Vector3d> worn(const std::vector<Eigen::Vector3d>& outer,
                                            const std::vector<Eigen::Vector3d>& inner) const = 0;
};

/// Binds a body to its control mesh. `body` gives the mesh and is called when it is needed first. How a body
/// follows its control mesh is the t-FFD's (tffd/), which this stage does not know: fit/bind_body.hpp.
/// `beta`: the reach that it carries the skin with (geometry/tffd_reach.hpp).
using BindBody = std::function<std::unique_ptr<const BodyUnderGarment>(
    std::function<geometry::TriangleMesh()> body, const geometry::ControlMesh& control,
    const geometry::BoneFrames& bones, double beta)>;

}  // namespace tensegric_fit::tensegric
