/// A garment line laid on the model: one tension along a polyline of outer nodes (P1 §3.5; DESIGN §4 "Lines
/// are bands").
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tensegric/garment.hpp"
#include "tensegric/model.hpp"
#include "tensegric/node_matrix.hpp"

namespace tensegric_fit::tensegric {

struct Band {
  std::string name;
  std::vector<int> nodes;  ///< outer nodes, in order
  TensionLaw law;
  double tension_limit;
  double initial, neutral, request;  ///< m, m, neutral / initial
  double smooth;                     ///< m, of shorter segments the length is smoothed
  bool movable;                      ///< it touches a free node
  bool steep;  ///< rigid, or so stiff that its length is better had from its tension than the other way round
  double straight = 0;  ///< m, least length: straight between the fixed nodes that it runs over
};

/// Bands of the garment's lines. A skin line runs over the mesh's edges from stop to stop, a taut one
/// straight. \throw Refusal unknown_line: a name that the control mesh does not have; bad_garment: region or
/// ratio
std::vector<Band> lay_bands(const Model& model, const Garment& garment);

/// Sum of the straight ways between one fixed node that the band runs over and the next, at `x`.
double straight_way(const Model& model, const Band& band, const Positions& x);

/// Length of the polyline. Smooth where a segment is shorter than `band.smooth` (1 mm, less on tiny models),
/// so that it may pass through zero; exact elsewhere.
double smooth_length(const Band& band, const Positions& x);

/// Change of the smooth length by the polyline's own, as its segments grow in proportion.
double smooth_slope(const Band& band, const Positions& x);

/// Adds `scale` times the smooth length's gradient by the free nodes.
void add_length_gradient(const Band& band, const Positions& x, const std::vector<int>& free_index,
                         double scale, Eigen::Ref<Eigen::VectorXd> gradient);

/// Adds `scale` times the smooth length's second derivative (positive semi-definite for scale >= 0).
void add_length_hessian(const Band& band, const Positions& x, const std::vector<int>& free_index,
                        double scale, NodeMatrix& hessian);

/// Tension of an elastic law, its slope by stretch, and its integral over stretch from 1. Beyond a table's
/// last row the last slope goes on. \pre the law is not rigid
double law_tension(const TensionLaw& law, double stretch);
double law_slope(const TensionLaw& law, double stretch);
double law_work(const TensionLaw& law, double stretch);

/// The other way round, for a steep law: stretch by tension, its slope, and the integral of the tension over
/// the stretch up to that tension. A rigid law has stretch 1. Defined for a tension below zero too, which a
/// solver may pass through.
double law_stretch(const TensionLaw& law, double tension);
double law_compliance(const TensionLaw& law, double tension);
double law_work_by_tension(const TensionLaw& law, double tension);

}  // namespace tensegric_fit::tensegric
