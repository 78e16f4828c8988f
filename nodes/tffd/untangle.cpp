#include "tffd/untangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace tensegric_fit::tffd {
namespace {

using Eigen::Vector3d;
constexpr int kMostRounds = 8;
constexpr double kSlender = 0.2;  // height / longest side of a needle at most

Vector3d facing(const Eigen::Vector3i& t, const std::vector<Vector3d>& at) {
  return geometry::area_vector(at[t[0]], at[t[1]], at[t[2]]);
}

// The widest corner lies opposite to the longest side.
Eigen::Vector3i widest_first(const Eigen::Vector3i& t, const std::vector<Vector3d>& at) {
  int widest = 0;
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    const double side = (at[t[(k + 1) % 3]] - at[t[(k + 2) % 3]]).squaredNorm();
    if (side <= longest) continue;
    longest = side;
    widest = k;
  }
  return {t[widest], t[(widest + 1) % 3], t[(widest + 2) % 3]};
}

double height_of(const Eigen::Vector3i& t, const std::vector<Vector3d>& at) {
  return facing(t, at).norm() / (at[t[2]] - at[t[1]]).norm();
}

Vector3d around(const std::vector<Eigen::Vector3i>& triangles, const std::vector<Vector3d>& at) {
  Vector3d sum = Vector3d::Zero();
  for (const Eigen::Vector3i& t : triangles) sum += facing(t, at);
  return sum;
}

}  // namespace

Untangle::Untangle(const geometry::TriangleMesh& body, const std::vector<Anchor>& anchors) {
  std::vector<char> carried(body.vertices.size(), 0);
  for (const Anchor& anchor : anchors) carried[anchor.vertex] = 1;
  std::map<std::pair<int, int>, std::vector<std::size_t>> needles_at;  // a side's ends
  for (const Eigen::Vector3i& corners : body.triangles) {
    const Eigen::Vector3i t = widest_first(corners, body.vertices);
    if (!carried[t[0]]) continue;
    const double side = (body.vertices[t[2]] - body.vertices[t[1]]).norm();
    if (!(height_of(t, body.vertices) < kSlender * side)) continue;
    for (int k = 0; k < 3; ++k) needles_at[std::minmax(t[k], t[(k + 1) % 3])].push_back(needles_.size());
    needles_.push_back({t, {}});
  }
  if (needles_.empty()) return;
  for (const Eigen::Vector3i& t : body.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto at = needles_at.find(std::minmax(t[k], t[(k + 1) % 3]));
      if (at == needles_at.end()) continue;
      for (const std::size_t needle : at->second) needles_[needle].beside.push_back(t);
    }
}

void Untangle::operator()(const std::vector<Vector3d>& rest, std::vector<Vector3d>& moved) const {
  bool turned = true;
  for (int round = 0; turned && round < kMostRounds; ++round) {
    turned = false;
    for (const Needle& needle : needles_) {
      const Eigen::Vector3i& t = needle.corners;
      const Vector3d now = facing(t, moved), before = facing(t, rest);
      if (now.dot(before) >= 0) continue;
      if (around(needle.beside, moved).dot(around(needle.beside, rest)) <= 0)
        continue;  // all the skin here is turned right round
      const Vector3d side = rest[t[2]] - rest[t[1]], side_now = moved[t[2]] - moved[t[1]];
      const double height = height_of(t, rest);
      const double along = std::clamp(side.dot(rest[t[0]] - rest[t[1]]) / side.squaredNorm(), 0.0, 1.0);
      moved[t[0]] = moved[t[1]] + along * side_now + height * before.cross(side_now).normalized();
      turned = true;
    }
  }
}

}  // namespace tensegric_fit::tffd
