/// The body that a garment lies on, as far as the tensegric stage needs it: to lay its bands and lines by
/// points, and to keep the body's volume.
#pragma once

#include <tensegric_fit/TriangleMesh.h>

#include <memory>
#include <mutex>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/fibre.hpp"
#include "geometry/posture.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/region_volume.hpp"
#include "tffd/binding.hpp"
#include "tffd/lay_line.hpp"

namespace tensegric_fit::node {

/// Bound to the control mesh (t-FFD) when it is first asked for something: strings need none of it.
/// Lines stay laid while they are asked for: a change of ratio does not move them. For any thread.
class BodyUnderGarment {
 public:
  BodyUnderGarment(TriangleMesh::ConstPtr body, const geometry::ControlMesh& control,
                   const geometry::BoneFrames& bones)
      : body_(std::move(body)), control_(control), bones_(bones) {}

  /// The garment's lines that lie on the body. \throw Refusal bad_garment: a point far from the skin;
  /// unknown_line: a node that the control mesh does not have
  std::vector<geometry::LaidLine> lay(const tensegric::Garment& garment) const;

  /// One per region of the control mesh.
  std::vector<tensegric::VolumeFunction> volumes() const;

 private:
  struct Bound {
    geometry::TriangleMesh mesh;
    tffd::Binding binding;
  };
  struct Line {
    tffd::LineOnBody on_body;
    std::vector<geometry::Fibre> fibres;
  };
  const Bound& bound() const;

  const TriangleMesh::ConstPtr body_;
  const geometry::ControlMesh control_;
  const geometry::BoneFrames bones_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<const Bound> bound_;
  mutable std::vector<Line> lines_;  // of the last garment
};

}  // namespace tensegric_fit::node
