#include "tffd/body_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/status.hpp"

namespace tensegric_fit::tffd {
namespace {

using geometry::Refusal;
namespace refusal = geometry::refusal;

// Of each body vertex, how much weight each region's nodes have in it; the last column is for nodes outside
// all regions.
SparseRows weight_by_region(const Binding& binding, const geometry::ControlMesh& control) {
  const SparseRows& values = binding.weights().values;
  const int regions = static_cast<int>(control.regions.size());
  std::vector<std::vector<int>> of_node(static_cast<std::size_t>(values.cols()));
  for (int r = 0; r < regions; ++r)
    for (const int t : control.regions[r].triangles)
      for (const int node : control.triangles[t])
        if (of_node[node].empty() || of_node[node].back() != r) of_node[node].push_back(r);
  std::vector<Eigen::Triplet<double>> members;
  for (std::size_t node = 0; node < of_node.size(); ++node) {
    if (of_node[node].empty()) of_node[node].push_back(regions);
    for (const int r : of_node[node]) members.emplace_back(static_cast<int>(node), r, 1);
  }
  SparseRows member(values.cols(), regions + 1);
  member.setFromTriplets(members.begin(), members.end());
  return values * member;
}

}  // namespace

std::vector<std::vector<Eigen::Vector3i>> carried_triangles(const Binding& binding,
                                                            const std::vector<Eigen::Vector3i>& triangles,
                                                            const geometry::ControlMesh& control) {
  const SparseRows weights = weight_by_region(binding, control);
  const int regions = static_cast<int>(control.regions.size());
  std::vector<std::vector<Eigen::Vector3i>> carried(control.regions.size());
  std::vector<double> sums(control.regions.size() + 1, 0);
  for (const Eigen::Vector3i& t : triangles) {
    for (const int v : t)
      for (SparseRows::InnerIterator weight(weights, v); weight; ++weight)
        sums[static_cast<std::size_t>(weight.col())] += weight.value();
    int most = regions;
    double largest = 0;
    for (const int v : t)
      for (SparseRows::InnerIterator weight(weights, v); weight; ++weight) {
        const int r = static_cast<int>(weight.col());
        if (sums[r] > largest || (sums[r] == largest && r < most)) {
          most = r;
          largest = sums[r];
        }
      }
    for (const int v : t)
      for (SparseRows::InnerIterator weight(weights, v); weight; ++weight)
        sums[static_cast<std::size_t>(weight.col())] = 0;
    if (largest > 0 && most < regions) carried[most].push_back(t);
  }
  return carried;
}

BodyVolume::BodyVolume(const Binding& binding, const std::vector<Eigen::Vector3i>& triangles,
                       const Eigen::Vector3d& apex)
    : apex_(apex), rest_nodes_(binding.outer()), starts_{0} {
  const SparseRows& m = binding.weights().nodes;
  if (m.cols() == 0)
    throw Refusal(refusal::kBadOption,
                  "t-FFD: the paper's setting has no constant weights to hold a volume by");
  rest_nodes_.insert(rest_nodes_.end(), binding.inner().begin(), binding.inner().end());

  constexpr int kUnused = -1, kUsed = -2;
  std::vector<int> index(binding.vertices().size(), kUnused);
  for (const Eigen::Vector3i& t : triangles)
    for (const int v : t) index[v] = kUsed;
  const auto add = [&](std::size_t v) {
    index[v] = static_cast<int>(rest_.size());
    rest_.push_back(binding.vertices()[v] - apex);
  };
  for (const Anchor& anchor : binding.anchors()) {
    if (index[anchor.vertex] != kUsed) continue;
    add(anchor.vertex);
    for (SparseRows::InnerIterator entry(m, anchor.vertex); entry; ++entry) {
      columns_.push_back(static_cast<int>(entry.col()));
      weights_.push_back(entry.value());
    }
    starts_.push_back(static_cast<int>(columns_.size()));
  }
  for (std::size_t v = 0; v < index.size(); ++v)
    if (index[v] == kUsed) add(v);
  for (const Eigen::Vector3i& t : triangles) triangles_.emplace_back(index[t[0]], index[t[1]], index[t[2]]);
  rest_volume_ = geometry::cone_volume(rest_, triangles_);
}

BodyVolume BodyVolume::posed(const geometry::BoneFrames& bones, double share) const {
  BodyVolume other = *this;
  if (bones.still() || share == 0) return other;
  other.apex_ = bones.moved(apex_, share);
  for (Eigen::Vector3d& node : other.rest_nodes_) node = bones.moved(node, share);
  for (Eigen::Vector3d& p : other.rest_) p = bones.moved(apex_ + p, share) - other.apex_;
  other.rest_volume_ = geometry::cone_volume(other.rest_, other.triangles_);
  return other;
}

double BodyVolume::operator()(const std::vector<Eigen::Vector3d>& nodes,
                              std::vector<Eigen::Vector3d>* gradient) const {
  if (nodes.size() != rest_nodes_.size())
    throw Refusal(refusal::kBadMesh,
                  "body volume: not the number of control nodes that the body was bound with");
  std::vector<Eigen::Vector3d> motion(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) motion[i] = nodes[i] - rest_nodes_[i];
  std::vector<Eigen::Vector3d> positions = rest_;
  const int reached = static_cast<int>(starts_.size()) - 1;
  for (int v = 0; v < reached; ++v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = starts_[v]; i < starts_[v + 1]; ++i) sum += weights_[i] * motion[columns_[i]];
    positions[v] += sum;
  }
  if (!gradient) return geometry::cone_volume(positions, triangles_);

  double six_volumes = 0;
  std::vector<Eigen::Vector3d> by_vertex(positions.size(), Eigen::Vector3d::Zero());
  for (const Eigen::Vector3i& t : triangles_) {
    const Eigen::Vector3d &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    const Eigen::Vector3d b_c = b.cross(c);
    six_volumes += a.dot(b_c);
    by_vertex[t[0]] += b_c;
    by_vertex[t[1]] += c.cross(a);
    by_vertex[t[2]] += a.cross(b);
  }
  gradient->assign(nodes.size(), Eigen::Vector3d::Zero());
  for (int v = 0; v < reached; ++v) {
    const Eigen::Vector3d sixth = by_vertex[v] / 6;
    for (int i = starts_[v]; i < starts_[v + 1]; ++i) (*gradient)[columns_[i]] += weights_[i] * sixth;
  }
  return six_volumes / 6;
}

}  // namespace tensegric_fit::tffd
