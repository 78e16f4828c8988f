/// The weights with which control triangles carry a vertex (P1 §3.2, ref. [10]; README.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/control_mesh.hpp"
#include "geometry/triangle_mesh.hpp"
#include "tffd/frame.hpp"
#include "tffd/needles.hpp"
#include "tffd/reach.hpp"
#include "tffd/triangle_grid.hpp"

namespace tensegric_fit::tffd {

/// Sparse and constant, one row a body vertex; rows of vertices that are no anchors are empty.
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Both have the anchor's share multiplied in.
struct Weights {
  /// M of q' = q + M (x - x at rest). One column a node: outer node i is i, inner node i is V + i.
  SparseRows nodes;
  /// What carries a value from the outer nodes to the skin: rows have no negative weight and sum to the
  /// share.
  SparseRows values;
};

/// How far a control triangle reaches, in multiples of its radius; which ones are in reach of a point; and
/// below which part of a vertex's largest kernel weight the others are dropped (the kept ones sum to 1).
struct Kernel {
  double beta;
  TriangleGrid grid;
  double truncation = 0;
  /// Of M, 1.6 GB: no body comes near, but all nodes carry a vertex that is far off every triangle.
  std::size_t most_entries = std::size_t{1} << 27;
};

/// \pre the frames run from inner to outer centroid
/// \throw Refusal bad_mesh: M would have more than Kernel::most_entries
Weights standard_weights(const geometry::TriangleMesh& body, const geometry::ControlMesh& control,
                         const std::vector<Frame>& frames, const Kernel& kernel,
                         const std::vector<Anchor>& anchors, const std::vector<Tie>& ties);

/// The row of M of any point, node and weight, ascending, without what is out of reach and below a thousandth
/// of the largest kernel weight. `outer`: how many outer nodes there are.
/// \pre the frames run from inner to outer centroid
std::vector<std::pair<int, double>> weights_at(const Eigen::Vector3d& q, double share, std::size_t outer,
                                               const std::vector<Eigen::Vector3i>& triangles,
                                               const std::vector<Frame>& frames, const Kernel& kernel);

/// One triangle's part in one vertex, with the unit normal for W.
struct NormalTerm {
  int triangle;
  double weight;          ///< sums to 1 over a vertex
  Eigen::Vector3d local;  ///< (u, v, w) at binding
};

/// The terms of vertex i are those from starts[i] to starts[i + 1]; none where the vertex is out of reach.
struct NormalTerms {
  std::vector<int> starts;
  std::vector<NormalTerm> terms;
};

/// The published setting: k = max(0, 1 - |q - G| / (beta r)), nothing else.
/// \pre the frames have unit normals for W
NormalTerms paper_terms(const std::vector<Eigen::Vector3d>& vertices, const std::vector<Frame>& frames,
                        const Kernel& kernel);

/// Weights::values of the published setting.
SparseRows paper_values(const std::vector<Eigen::Vector3d>& vertices, const geometry::ControlMesh& control,
                        const std::vector<Frame>& frames, const NormalTerms& bound);

}  // namespace tensegric_fit::tffd
