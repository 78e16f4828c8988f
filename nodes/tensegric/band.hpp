/// A garment line laid on the model: one tension along a polyline of outer nodes, or along the fibres of a
/// band on the body (P1 §3.5; README.md, Lines and bands).
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "geometry/fibre.hpp"
#include "geometry/posture.hpp"
#include "tensegric/garment.hpp"
#include "tensegric/model.hpp"

namespace tensegric_fit::tensegric {

/// A polyline whose points nodes carry: each point is `offset` and the weighted sum of their positions.
struct Thread {
  double share;  ///< of its length in the band's
  std::vector<geometry::CarriedPoint> points;
  std::vector<Eigen::Vector3d> offsets;                    ///< one per point; zero where a point is a node
  std::vector<std::vector<std::pair<int, double>>> spans;  ///< of each segment: node, and weight in its span
};

/// Its length is the threads' mean by their shares.
struct Band {
  std::string name;
  std::vector<int> nodes;  ///< outer nodes, in order, that a line by `through` runs over
  std::vector<Thread> threads;
  TensionLaw law;
  double tension_limit;
  double width = 0;                  ///< m; 0: a thread; of a cup where its fibres begin to spread
  bool cup = false;                  ///< its threads spread
  double initial, neutral, request;  ///< m, m, neutral / initial
  double smooth;                     ///< m, of shorter segments the length is smoothed
  bool movable;                      ///< it touches a free node
  bool steep;  ///< rigid, or so stiff that its length is better had from its tension than the other way round
  double straight = 0;  ///< m, least length: straight between the fixed nodes that it runs over
};

/// Bands of the garment's lines. A string runs over the mesh's edges from stop to stop, a taut one
/// straight; a line on the body is found in `laid` by its name. \throw Refusal as nodes_of
/// (course.hpp); bad_garment: a ratio, or a line on the body that is not in `laid`;
/// bad_mesh: a line without length
std::vector<Band> lay_bands(const Model& model, const Garment& garment,
                            const std::vector<geometry::LaidLine>& laid = {});

/// Where its points are.
std::vector<Eigen::Vector3d> points_of(const Thread& thread, const Positions& x);

/// Takes the parts of a band on the body that no node carries to `share` of a posture. `rest`: of the nodes,
/// before it.
void pose_band(Band& band, const Positions& rest, const geometry::BoneFrames& bones, double share);

/// Sum of the straight ways between one fixed point of the band and the next, at `x`.
double straight_way(const Model& model, const Band& band, const Positions& x);

}  // namespace tensegric_fit::tensegric
