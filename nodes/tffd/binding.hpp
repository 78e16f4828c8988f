/// t-FFD: free-form deformation by a triangular mesh (P1 §3.2, ref. [10]; DESIGN §5).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"

namespace tensegric_fit::tffd {

/// `standard`: W from inner to outer centroid, smooth kernel: q' = M x, affine-exact. `paper`: unit normal, linear kernel.
enum class Setting { standard, paper };

/// Field defaults are the parameters' defaults.
struct Options {
  Setting setting = Setting::standard;
  double beta = 2.0;  ///< reach of a triangle in multiples of its mean radius (paper: 2.5)
};

/// Body vertices bound to a control mesh at rest.
class Binding {
 public:
  /// \throw Refusal bad_option, bad_mesh
  Binding(const std::vector<Eigen::Vector3d>& vertices, const geometry::ControlMesh& control, const Options& options);

  /// Positions of all vertices for the control nodes at `outer` and `inner`. Vertices out of reach stay, bit for bit.
  std::vector<Eigen::Vector3d> deform(const std::vector<Eigen::Vector3d>& outer,
                                      const std::vector<Eigen::Vector3d>& inner) const;
};

}  // namespace tensegric_fit::tffd
