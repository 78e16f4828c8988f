/// One body before and under a garment, ready to be drawn.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "inspect/colour_scale.hpp"
#include "inspect/skin_stretch.hpp"

namespace tensegric_fit::inspect {

/// Brings a body's mesh and its deformed vertices together by the scan that both are of. What does not fit is
/// refused in words, and what was there before stays. For one thread.
class BodyView {
 public:
  /// The body under a garment, vertices in the scan's frame, metres; distortion one per vertex.
  struct Worn {
    std::string scan_id, garment;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<double> distortion;
  };

  /// What is worn over the same scan stays. A deformed body that waited for it and does not fit is dropped,
  /// see note(). \throw Refusal bad_mesh, non_finite
  void take_body(const std::string& scan_id, geometry::TriangleMesh mesh);

  /// Of the body at hand, or of one that is still to come: then it waits for it. \throw Refusal bad_mesh:
  /// another number of vertices; non_finite
  void take_worn(Worn worn);

  /// Holds nothing of that scan any more. False: it held nothing of it.
  bool forget(const std::string& scan_id);

  bool empty() const { return mesh_.triangles.empty(); }
  bool is_worn() const { return worn_.has_value(); }
  const std::string& scan_id() const { return scan_id_; }
  /// Empty where nothing is worn.
  std::string garment() const { return worn_ ? worn_->garment : ""; }
  /// What is not shown, and why: a sentence, or empty.
  const std::string& note() const { return note_; }

  /// At rest. Changes with take_body alone.
  const geometry::TriangleMesh& mesh() const { return mesh_; }
  /// Of the mesh: another one for each that was taken, of the same scan too.
  int revision() const { return revision_; }

  /// The vertices between rest (0) and worn (1); at rest where nothing is worn.
  std::vector<Eigen::Vector3d> vertices(double blend) const;

  /// What the worn body's colours stand for, one per vertex, `blend` of the way from rest: 1, or 0 for a
  /// displacement, where nothing is worn.
  std::vector<double> values(ColourBy by, double blend) const;

 private:
  void check(const Worn& worn) const;

  std::string scan_id_, note_;
  geometry::TriangleMesh mesh_;
  int revision_ = 0;
  std::optional<SkinStretch> stretch_;
  std::optional<Worn> worn_, waiting_;
};

}  // namespace tensegric_fit::inspect
