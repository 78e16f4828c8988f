/// The tensegric model on a control mesh (P1 §3.1-3.2, P2 §2.1; DESIGN §4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/control_mesh.hpp"

namespace tensegric_fit::tensegric {

/// Field defaults are the parameters' defaults.
struct ModelOptions {
  double strut_stiffness = 0.3;  ///< k_s / k
};

/// A strut (two-way spring) or a tensile part (pulls only) between two nodes.
struct Member {
  int a, b;       ///< nodes: outer node i is i, inner node i is V + i
  bool strut;
  double rest;    ///< length at rest, m
  double natural; ///< length at zero force, m
};

struct Model {
  geometry::ControlMesh control;      ///< at rest
  std::vector<Member> members;        ///< 3F struts, then 2E + V tensile parts
  ModelOptions options;
  int struts() const;
  int tensile_parts() const;
  int free_nodes() const;
};

/// Members and prestress, such that the undeformed model is in exact equilibrium.
/// \throw Refusal bad_mesh, bad_option
Model build_model(const geometry::ControlMesh& control, const ModelOptions& options);

}  // namespace tensegric_fit::tensegric
