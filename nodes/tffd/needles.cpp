#include "tffd/needles.hpp"

#include <algorithm>
#include <cmath>

namespace tensegric_fit::tffd {
namespace {

constexpr double kNarrow = 0.05;  // height / longest side

struct Needle {
  Tie tie;
  double narrowness;  // height / longest side
};

Needle needle_of(const std::vector<Eigen::Vector3d>& vertices, const Eigen::Vector3i& t) {
  int top = 0;
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = (vertices[t[(k + 2) % 3]] - vertices[t[(k + 1) % 3]]).squaredNorm();
    if (side > longest) longest = side, top = k;
  }
  const int from = t[(top + 1) % 3], to = t[(top + 2) % 3];
  const Eigen::Vector3d along = vertices[to] - vertices[from], up = vertices[t[top]] - vertices[from];
  const double part = longest > 0 ? std::clamp(along.dot(up) / longest, 0.0, 1.0) : 0;
  const double height = (up - part * along).norm();
  return {{t[top], from, to, part}, longest > 0 ? height / std::sqrt(longest) : 0};
}

}  // namespace

std::vector<Tie> tie_needles(const geometry::TriangleMesh& body, std::vector<Anchor>& anchors) {
  std::vector<double> shares(body.vertices.size(), 0);
  for (const Anchor& anchor : anchors) shares[anchor.vertex] = anchor.share;
  std::vector<Needle> needles;
  for (const Eigen::Vector3i& t : body.triangles) {
    if (shares[t[0]] == 0 && shares[t[1]] == 0 && shares[t[2]] == 0) continue;
    const Needle needle = needle_of(body.vertices, t);
    if (needle.narrowness < kNarrow) needles.push_back(needle);
  }
  std::stable_sort(needles.begin(), needles.end(),
                   [](const Needle& a, const Needle& b) { return a.narrowness < b.narrowness; });

  enum Role : char { none, carries, tied };
  std::vector<Role> roles(shares.size(), none);
  std::vector<Tie> ties;
  for (const Needle& needle : needles) {
    const Tie& tie = needle.tie;
    if (roles[tie.vertex] != none || roles[tie.from] == tied || roles[tie.to] == tied) continue;
    const double share = shares[tie.from] + tie.part * (shares[tie.to] - shares[tie.from]);
    if (share == 0) continue;
    roles[tie.vertex] = tied;
    roles[tie.from] = roles[tie.to] = carries;
    shares[tie.vertex] = share;
    ties.push_back(tie);
  }
  anchors.clear();
  for (std::size_t v = 0; v < shares.size(); ++v)
    if (shares[v] > 0) anchors.push_back({static_cast<int>(v), shares[v]});
  return ties;
}

}  // namespace tensegric_fit::tffd
