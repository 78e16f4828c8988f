/// t-FFD: free-form deformation by a triangular mesh (P1 §3.2, ref. [10]; README.md).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/fibre.hpp"
#include "geometry/posture.hpp"
#include "geometry/range.hpp"
#include "geometry/surface_tree.hpp"
#include "geometry/tffd_reach.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/reach.hpp"
#include "tffd/untangle.hpp"
#include "tffd/weights.hpp"

namespace tensegric_fit::tffd {

/// `standard`: W from inner to outer centroid, smooth kernel, no tear at a fixed border: q' = q + M (x - x at
/// rest) with constant M; affine-exact wherever the share of the motion is 1 (reach.hpp). The absolute
/// entries of a row of M sum to 3 at most, or to what the best triangle in reach makes of the vertex alone;
/// of a corner that is tied to a needle's side (needles.hpp) to as much for its height over that side, and as
/// much for the place on the side: 6 at most, and hardly more than 3, as it is no higher than a twentieth of
/// the side. `paper`: as published, W the unit normal and a linear kernel; the skin tears where the control
/// mesh ends.
enum class Setting { standard, paper };

/// Of the standard setting's evaluation. `fast`: weights and displacements in single precision, within 0.01
/// mm of `reference`, which is double throughout.
enum class Precision { reference, fast };

inline constexpr geometry::Range kTruncation{0, 0.1};

/// Field defaults are the parameters' defaults.
struct Options {
  Setting setting = Setting::standard;
  double beta = 0;  ///< reach of a triangle in its mean radii; 0: the setting's own, 1.3 (paper: 2.5)
  Precision precision = Precision::reference;
  /// Kernel weights below this part of a vertex's largest are dropped and the others scaled up: fewer entries
  /// in M, affine-exact all the same; what it costs says Binding::truncation_error. 0: none.
  double truncation = 0;
};

/// \throw Refusal bad_option: beta, truncation, or anything but the defaults of precision and truncation in
/// the paper's setting
void check_options(const Options& options);

/// A body bound to a control mesh at rest.
class Binding {
 public:
  /// Uses the control mesh's nodes, triangles and fixed flags.
  /// \throw Refusal bad_option: beta, truncation, or anything but the defaults of precision and truncation in
  /// the paper's setting, which has no constant M; bad_mesh: no control triangles, a flat one, free nodes and
  /// no skin that they carry, a shape too far off (Kernel::most_entries); non_finite
  Binding(const geometry::TriangleMesh& body, const geometry::ControlMesh& control, const Options& options);

  /// Positions of all vertices for the control nodes at `outer` and `inner`: M's, but for corners of needles
  /// that would turn over (untangle.hpp). Vertices that are no anchors
  /// stay, bit for bit, and with all nodes at rest every vertex does (paper: to rounding).
  /// \throw Refusal bad_mesh: another number of nodes than was bound; non_finite
  std::vector<Eigen::Vector3d> deform(const std::vector<Eigen::Vector3d>& outer,
                                      const std::vector<Eigen::Vector3d>& inner) const;

  /// The same binding in another posture: body and nodes at rest go where the bones carry them, and deform()
  /// starts from there (P2 §6). With still bones it is this one, bit for bit.
  Binding posed(const geometry::BoneFrames& bones) const;

  /// No vertex is farther from where it were without truncation than this times the farthest that a node
  /// moved: the largest row sum of |M - M truncated|, metres per metre.
  double truncation_error() const { return truncation_error_; }

  /// M, and what carries values. In the paper's setting there is no constant M, and `nodes` is empty.
  const Weights& weights() const { return weights_; }

  /// The vertices that follow the control mesh, ascending.
  const std::vector<Anchor>& anchors() const { return anchors_; }

  /// A point of the body as it was bound, in a triangle with these corners: the mapping itself, not what
  /// straight lines between the vertices make of it, so that a garment pulls alike on coarse and fine meshes
  /// of a body. With corners' shares of the motion between. \pre the standard setting
  geometry::CarriedPoint carried(const geometry::SurfacePoint& at, const Eigen::Vector3i& corners) const;

  /// Whether the control mesh can move that vertex.
  bool reaches(int vertex) const { return share_of(vertex) > 0; }

  /// Where everything is at rest.
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Eigen::Vector3d>& outer() const { return outer_; }
  const std::vector<Eigen::Vector3d>& inner() const { return inner_; }

  const std::vector<Eigen::Vector3i>& control_triangles() const { return triangles_; }

 private:
  double share_of(int vertex) const;  // 0 of one that is no anchor
  void move_by_weights(const std::vector<Eigen::Vector3d>& outer, const std::vector<Eigen::Vector3d>& inner,
                       std::vector<Eigen::Vector3d>& moved) const;
  void move_by_normals(const std::vector<Eigen::Vector3d>& outer, std::vector<Eigen::Vector3d>& moved) const;

  Setting setting_;
  Precision precision_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3d> outer_, inner_;
  std::vector<Eigen::Vector3i> triangles_;
  std::vector<Frame> frames_;
  std::optional<Kernel> kernel_;
  std::vector<Anchor> anchors_;
  Untangle untangle_;  // not in the paper's setting
  Weights weights_;
  std::vector<float> float_weights_;  // the entries of M in the fast precision, else empty
  NormalTerms terms_;                 // empty but in the paper's setting
  double truncation_error_ = 0;
};

}  // namespace tensegric_fit::tffd
