#include "tffd/needles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tffd/binding.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// The slab with one vertex a hundredth of the way off the middle of every seventh edge, and the two triangles
// on that edge drawn to it: one of them is a needle in each such place.
geometry::TriangleMesh slab_with_needles(std::vector<int>& tops) {
  geometry::TriangleMesh body = slab(61);
  std::vector<char> used(body.triangles.size(), 0);
  int number = 0;
  for (const geometry::Edge& edge : geometry::edges_of(body)) {
    if (edge.right < 0 || used[edge.left] || used[edge.right] || ++number % 7 != 0) continue;
    used[edge.left] = used[edge.right] = 1;
    const auto top_of = [&](int t) { return body.triangles[t].sum() - edge.first - edge.second; };
    const int left = top_of(edge.left), top = static_cast<int>(body.vertices.size());
    const Eigen::Vector3d middle = (body.vertices[edge.first] + body.vertices[edge.second]) / 2;
    body.vertices.push_back(middle + 0.005 * (body.vertices[left] - middle));
    tops.push_back(top);
    // The left triangle becomes two; the needle stays between them and the right one.
    body.triangles[edge.left] = {edge.first, top, left};
    body.triangles.emplace_back(top, edge.second, left);
    body.triangles.emplace_back(edge.first, edge.second, top);
    used.resize(body.triangles.size(), 1);
  }
  return body;
}

int turned_over(const geometry::TriangleMesh& body, const Points& after) {
  int count = 0;
  for (const Eigen::Vector3i& t : body.triangles) {
    const auto normal = [&t](const Points& p) { return geometry::area_vector(p[t[0]], p[t[1]], p[t[2]]); };
    count += normal(body.vertices).dot(normal(after)) <= 0;
  }
  return count;
}

TEST(Needles, DoNotTurnOver) {
  std::vector<int> tops;
  const geometry::TriangleMesh body = slab_with_needles(tops);
  const geometry::ControlMesh control = patch();
  const Moved moved = squeezed(control, 0.03);
  const Points after = Binding(body, control, {}).deform(moved.outer, moved.inner);
  EXPECT_EQ(turned_over(body, after), 0);

  // They do where each vertex follows the control mesh by itself: that is what the ties are for.
  const Points alone =
      Binding({body.vertices, slab(61).triangles}, control, {}).deform(moved.outer, moved.inner);
  EXPECT_GT(turned_over(body, alone), 0);
}

TEST(Needles, AreCarriedAffineExactly) {
  const geometry::ControlMesh control = ball();
  geometry::TriangleMesh body = sphere(0.1, 30);
  // Every third triangle gets a vertex near the middle of a side, and thereby a needle.
  const std::size_t count = body.triangles.size();
  for (std::size_t i = 0; i < count; i += 3) {
    const Eigen::Vector3i t = body.triangles[i];
    const int top = static_cast<int>(body.vertices.size());
    body.vertices.push_back(0.495 * (body.vertices[t[0]] + body.vertices[t[1]]) + 0.01 * body.vertices[t[2]]);
    body.triangles[i] = {top, t[1], t[2]};
    body.triangles.emplace_back(t[0], top, t[2]);
    body.triangles.emplace_back(t[0], t[1], top);
  }
  std::vector<Anchor> all;
  for (std::size_t v = 0; v < body.vertices.size(); ++v) all.push_back({static_cast<int>(v), 1});
  ASSERT_GT(tie_needles(body, all).size(), count / 4);

  Eigen::Matrix3d a;
  a << 1.1, 0.12, -0.05, 0.02, 0.93, 0.07, -0.03, 0.04, 1.21;
  const auto image = [&a](Points points) {
    for (Eigen::Vector3d& p : points) p = a * p + Eigen::Vector3d(0.1, 0, -0.2);
    return points;
  };
  const Points after = Binding(body, control, {}).deform(image(control.outer), image(control.inner));
  const Points expected = image(body.vertices);
  for (std::size_t v = 0; v < after.size(); ++v) EXPECT_LT((after[v] - expected[v]).norm(), 1e-12);
}

TEST(Needles, TieTheCornerOverTheLongestSide) {
  const geometry::TriangleMesh body{{{0, 0, 0}, {1, 0, 0}, {0.25, 0.01, 0}, {0.5, 1, 0}, {0.5, -1, 0}},
                                    {{0, 1, 2}, {2, 1, 3}, {0, 4, 1}}};
  std::vector<Anchor> anchors{{0, 0.4}, {1, 0.8}, {2, 1}, {3, 1}, {4, 1}};
  const std::vector<Tie> ties = tie_needles(body, anchors);
  ASSERT_EQ(ties.size(), 1U);
  EXPECT_EQ(ties[0].vertex, 2);
  EXPECT_EQ(ties[0].from, 0);
  EXPECT_EQ(ties[0].to, 1);
  EXPECT_NEAR(ties[0].part, 0.25, 1e-15);
  EXPECT_NEAR(anchors[2].share, 0.5, 1e-15);  // a quarter of the way from 0.4 to 0.8

  anchors = {{1, 0.8}, {3, 1}};  // a vertex out of reach has no share, and gets one where it is tied
  ASSERT_EQ(tie_needles(body, anchors).size(), 1U);
  ASSERT_EQ(anchors.size(), 3U);
  EXPECT_EQ(anchors[1].vertex, 2);
  EXPECT_NEAR(anchors[1].share, 0.2, 1e-15);
  anchors = {{2, 1}, {3, 1}};  // ends that stay hold nothing
  EXPECT_TRUE(tie_needles(body, anchors).empty());
}

TEST(Needles, NeitherTieTwiceNorToATiedVertex) {
  std::vector<int> tops;
  const geometry::TriangleMesh body = slab_with_needles(tops);
  std::vector<Anchor> all;
  for (std::size_t v = 0; v < body.vertices.size(); ++v) all.push_back({static_cast<int>(v), 1});
  const std::vector<Tie> ties = tie_needles(body, all);
  EXPECT_EQ(ties.size(), tops.size());
  std::map<int, int> times;
  for (const Tie& tie : ties) ++times[tie.vertex];
  for (const Tie& tie : ties) {
    EXPECT_EQ(times[tie.vertex], 1);
    EXPECT_EQ(times.count(tie.from) + times.count(tie.to), 0U);
  }
}

}  // namespace
}  // namespace tensegric_fit::tffd
