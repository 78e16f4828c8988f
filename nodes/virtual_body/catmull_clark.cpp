#include "virtual_body/catmull_clark.hpp"

#include <algorithm>
#include <map>

#include "geometry/status.hpp"

namespace tensegric_fit::virtual_body {
namespace {

void check(bool holds, const char* what) {
  if (!holds) throw geometry::Refusal(geometry::refusal::kBadMesh, what);
}

}  // namespace

CatmullClark::CatmullClark(std::size_t vertices, const std::vector<Quad>& quads)
    : coarse_(quads), valence_(vertices, 0) {
  const int count = static_cast<int>(vertices);
  std::map<std::array<int, 2>, int> edge_at;  // ends, the lower first -> index
  std::vector<std::array<int, 4>> edges_after(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k) {
      const int a = quads[q][k], b = quads[q][(k + 1) % 4];
      check(a >= 0 && a < count && b >= 0 && b < count && a != b, "a quad's vertex is not there");
      ++valence_[a];
      const auto [at, is_new] =
          edge_at.insert({{std::min(a, b), std::max(a, b)}, static_cast<int>(edges_.size())});
      if (is_new) edges_.push_back({at->first, {-1, -1}});
      int& side = edges_[at->second].sides[a < b ? 0 : 1];
      check(side < 0, "two quads run along an edge the same way");
      side = static_cast<int>(q);
      edges_after[q][k] = at->second;
    }
  for (const Edge& edge : edges_) check(edge.sides[0] >= 0 && edge.sides[1] >= 0, "the quads are not closed");
  check(std::find(valence_.begin(), valence_.end(), 0) == valence_.end(), "a vertex has no quad");

  const int first_edge = count, first_quad = count + static_cast<int>(edges_.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int k = 0; k < 4; ++k)
      quads_.push_back({quads[q][k], first_edge + edges_after[q][k], first_quad + static_cast<int>(q),
                        first_edge + edges_after[q][(k + 3) % 4]});
}

std::vector<Eigen::Vector3i> triangles_of(const std::vector<Quad>& quads) {
  std::vector<Eigen::Vector3i> triangles;
  for (const Quad& q : quads) {
    triangles.emplace_back(q[0], q[1], q[2]);
    triangles.emplace_back(q[0], q[2], q[3]);
  }
  return triangles;
}

}  // namespace tensegric_fit::virtual_body
