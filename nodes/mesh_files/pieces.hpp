/// The pieces of a surface, and which of their triangles run against each other.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// Triangles that are joined by edges of two, each with whether it runs against the first of its piece.
class Pieces {
 public:
  explicit Pieces(const geometry::TriangleMesh& mesh);

  /// The piece's first triangle.
  int root(int triangle) { return seen(triangle).first; }
  bool is_against(int triangle) { return seen(triangle).second; }

  /// False of a surface with one side only, as a Moebius strip, but for a hundredth of its edges.
  bool have_two_sides() const { return have_two_sides_; }
  /// Triangles at edges that do not fit in: of pieces whose two sides are not known.
  const std::vector<int>& one_sided() const { return one_sided_; }

 private:
  bool join(int a, int b, bool against);  // false where they are joined already, the other way round
  std::pair<int, bool> seen(int triangle);

  std::vector<int> parent_;
  std::vector<char> against_;
  std::vector<int> one_sided_;
  bool have_two_sides_;
};

/// Triangles that run against most of their piece, by area, are turned. Of pieces with one side only none.
geometry::TriangleMesh turned_alike(geometry::TriangleMesh mesh);

}  // namespace tensegric_fit::mesh_files
