/// Lays a garment's line on the body and lets the control mesh carry it (README.md).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/fibre.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/binding.hpp"

namespace tensegric_fit::tffd {

/// A band's middle line and how it lies. Metres, scan frame.
struct LineOnBody {
  std::vector<Eigen::Vector3d> points;  ///< on the skin or near it, two or more; of a cup one or more
  double width = 0;                     ///< of the band; 0: one thread
  double smooth = 0;                    ///< what its fibres average over, to either side along the band
  bool taut = false;                    ///< bridges hollows instead of following the skin
  /// Its first and its last end: held in space, or carried by the skin.
  std::array<bool, 2> held{true, true};
  /// Of a cup, else empty: ways from its last point to places in a row, two or more. From that point on its
  /// fibres spread, each by the shortest way over the skin beside these, and end evenly along the row.
  std::vector<std::vector<Eigen::Vector3d>> fan{};
};

/// Fibres across the band's width, on the skin of `body` at rest, carried by the binding's nodes as the skin
/// is; nothing carries an end that is held, and points averaged with it, or on a span from it, hang on it in
/// part. Their shares are even over the width. The first is the rightmost as one goes along the line with the
/// outside up. `body` is the one that was bound. \pre a cup has a width \throw Refusal bad_garment: a point
/// farther than 30 mm from the skin, or a line without length; bad_option: a binding in the paper's setting,
/// which has no constant M
std::vector<geometry::Fibre> lay_line(const LineOnBody& line, const geometry::TriangleMesh& body,
                                      const Binding& binding);

}  // namespace tensegric_fit::tffd
