/// What is drawn over a body in lines: control mesh and garment.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "inspect/colours.hpp"

namespace tensegric_fit::inspect {

/// An open polyline in one colour; metres.
struct Stroke {
  std::vector<Eigen::Vector3d> points;
  Colour colour;
};

/// A garment line with the force along it.
struct TenseLine {
  std::string name;
  std::vector<int> nodes;  ///< outer nodes of the control mesh that it runs over
  double tension;          ///< pseudo force
  /// Where it runs, for a line that lies on the skin and not over nodes; m, one per point.
  std::vector<Eigen::Vector3d> course_at_rest{}, course{};
};

/// A band of a garment, a little above the skin: fibres from edge to edge, as many points on each; metres.
struct Ribbon {
  std::vector<std::vector<Eigen::Vector3d>> fibres;
  Colour colour;
};

/// A band as it lies on the skin at rest and worn: fibres from edge to edge, as many points on each; metres.
struct BandOnSkin {
  std::string line;
  double tension;  ///< pseudo force
  std::vector<std::vector<Eigen::Vector3d>> at_rest, worn;
};

/// The nodes a little above the skin: chords between them would sink into it.
std::vector<Eigen::Vector3d> lifted(const std::vector<Eigen::Vector3d>& outer,
                                    const std::vector<Eigen::Vector3i>& triangles);

/// One stroke an edge, over the outer nodes at `outer`.
std::vector<Stroke> edge_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer);

/// One per line, coloured by tension. \throw Refusal bad_mesh: a node that the control mesh does not have
std::vector<Stroke> line_strokes(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer,
                                 const std::vector<TenseLine>& lines);

/// One per band, coloured by tension.
std::vector<Ribbon> band_ribbons(const geometry::ControlMesh& control,
                                 const std::vector<Eigen::Vector3d>& outer,
                                 const std::vector<BandOnSkin>& bands, double blend);

/// From `rest` (blend 0) to `worn` (1). \pre as many points
std::vector<Eigen::Vector3d> between(const std::vector<Eigen::Vector3d>& rest,
                                     const std::vector<Eigen::Vector3d>& worn, double blend);

}  // namespace tensegric_fit::inspect
