/// The tensegric model on a control mesh (P1 §3.1-3.2, P2 §2.1; DESIGN §4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"

namespace tensegric_fit::tensegric {

/// Node positions: outer node i at i, inner node i at V + i. Metres, the scan's frame.
using Positions = std::vector<Eigen::Vector3d>;

inline constexpr double kSoftestStrut = 1e-3, kStiffestStrut = 1e6;
inline constexpr double kLowestPrestress = 1e-6, kHighestPrestress = 0.5;

/// Field defaults are the parameters' defaults.
struct ModelOptions {
  double strut_stiffness = 0.3;  ///< k_s / k: the papers' rigid strut is the limit
  double prestress = 0.05;       ///< mean tension of the tensile parts at rest / k
};

/// A strut (two-way spring) or a tensile part (pulls only) between two nodes. Stiffness k / rest for a
/// tensile part and k_s / rest for a strut, with k = 1: forces are pseudo forces.
struct Member {
  int a, b;  ///< nodes: outer node i is i, inner node i is V + i
  bool strut;
  double rest;     ///< length at rest, m
  double natural;  ///< length at zero force, m
};

struct Model {
  geometry::ControlMesh control;  ///< at rest
  std::vector<Member> members;    ///< 3F struts, then 2E + V tensile parts
  ModelOptions options;
  int struts() const;
  int tensile_parts() const;
  int free_nodes() const;  ///< outer and inner
  bool is_fixed(int node) const;
  std::vector<int> free_index() const;  ///< of each node its number among the free ones, or -1
  Positions rest_positions() const;
  double mean_tension() const;  ///< of the tensile parts at rest, pseudo force
};

/// Members and prestress, such that the undeformed model is in exact equilibrium. Two struts cross in a side
/// face between two triangles, which mirrors; a side face on the rim has one, so that a model is
/// mirror-symmetric where the rim's inner nodes are fixed (else to some 10 micrometres). \throw Refusal
/// bad_mesh, bad_option
Model build_model(const geometry::ControlMesh& control, const ModelOptions& options);

}  // namespace tensegric_fit::tensegric
