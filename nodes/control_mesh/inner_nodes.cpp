#include "control_mesh/inner_nodes.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/status.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;
constexpr double kShareOfBody = 0.4;  // of the way through the body: the inner node stays inside
constexpr double kLeastVolumeShare =
    0.1;  // of the outer triangle's area that the inner one must keep, facing the same way
// Openness that units over bone are given: 0.05 and 0.2 came as near to finite elements, within 0.03 mm.
constexpr double kOpen = 0.1;
constexpr int kMostSlides = 30;  // 300 leave as much undone
// Of an edge, in one of them: a unit that no slide opens, with its skin towards the bone, stays near where it
// was.
constexpr double kLongestSlide = 0.3;
constexpr int kSmoothingRounds = 2;
constexpr double kShrink = 0.9;
constexpr int kMostRounds = 40;
constexpr double kBelowSkin = 1e-4;   // m; where the ray through the body starts, or
constexpr double kBelowShare = 0.01;  // of the thickness where that is less
// Of the largest pivot. Rounding leaves 1e-16 of a node that nothing fixes; of a clamped grid of 100 by 100
// none is below 1e-7.
constexpr double kLeastPivot = 1e-12;

/// Normals averaged with those around them: below a sharp fold the inner nodes spread out all the same.
std::vector<Vector3d> smooth_normals(const geometry::ControlMesh& control) {
  std::vector<Vector3d> normals = geometry::vertex_normals(control.outer, control.triangles);
  const auto around = geometry::neighbours_of(control.outer.size(), control.triangles);
  for (int round = 0; round < kSmoothingRounds; ++round) {
    const std::vector<Vector3d> before = normals;
    for (std::size_t v = 0; v < normals.size(); ++v) {
      Vector3d mean = Vector3d::Zero();
      for (int neighbour : around[v]) mean += before[neighbour];
      normals[v] = (before[v] + mean / static_cast<double>(around[v].size())).normalized();
    }
  }
  return normals;
}

// Rows of the umbrella operator at nodes off the rim, each neighbour by 1 / its distance.
Eigen::SparseMatrix<double> umbrellas(const geometry::ControlMesh& control) {
  const int count = static_cast<int>(control.outer.size());
  std::vector<char> on_rim(control.outer.size(), 0);
  std::vector<std::vector<std::pair<int, double>>> around(control.outer.size());
  for (const geometry::Edge& edge : geometry::edges_of({control.outer, control.triangles})) {
    if (edge.right < 0) on_rim[edge.first] = on_rim[edge.second] = 1;
    const double weight = 1 / (control.outer[edge.first] - control.outer[edge.second]).norm();
    around[edge.first].emplace_back(edge.second, weight);
    around[edge.second].emplace_back(edge.first, weight);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < count; ++i) {
    if (on_rim[i]) continue;
    double sum = 0;
    for (const auto& [j, weight] : around[i]) sum += weight;
    for (const auto& [j, weight] : around[i]) entries.emplace_back(i, j, weight / sum);
    entries.emplace_back(i, i, -1);
  }
  Eigen::SparseMatrix<double> rows(count, count);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

// The nodes at `places`, those that are not held moved to where the surface through the held ones bends
// least.
void bend_least(const geometry::ControlMesh& control, std::vector<Vector3d>& places) {
  const int count = static_cast<int>(places.size());
  std::vector<int> number(places.size(), -1);
  int unknowns = 0;
  for (int i = 0; i < count; ++i)
    if (!control.inner_fixed[i]) number[i] = unknowns++;
  if (unknowns == 0) return;
  const Eigen::SparseMatrix<double> rows = umbrellas(control), bending = rows.transpose() * rows;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, 3);
  for (int j = 0; j < count; ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(bending, j); entry; ++entry) {
      const int i = static_cast<int>(entry.row());
      if (number[i] < 0) continue;
      if (number[j] >= 0)
        entries.emplace_back(number[i], number[j], entry.value());
      else
        right.row(number[i]) -= entry.value() * places[j].transpose();
    }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::VectorXd pivots = factor.vectorD().cwiseAbs();
  const Eigen::MatrixXd at = factor.solve(right);
  if (factor.info() != Eigen::Success || !(pivots.minCoeff() > kLeastPivot * pivots.maxCoeff()) ||
      !at.allFinite())
    throw geometry::Refusal(
        geometry::refusal::kBadTemplate,
        "no bone surface: the template's inner nodes that are held do not fix the others");
  for (int i = 0; i < count; ++i)
    if (number[i] >= 0) places[i] = at.row(number[i]);
}

// How far a unit is from being turned inside out, and what changes it: the volume between each of its
// triangles and the middle of the other, over that of an upright unit of the same outer triangle and depth.
// The solver keeps both above 0.
struct Openness {
  double share;
  std::array<Vector3d, 3> by_inner;  // its derivative by the inner nodes at this depth, 1/m
};
std::array<Openness, 2> openness_of(const std::vector<Vector3d>& outer, const std::vector<Vector3d>& inner,
                                    const Eigen::Vector3i& corners) {
  const auto& [a, b, c] = std::array<int, 3>{corners[0], corners[1], corners[2]};
  const Vector3d upper = geometry::area_vector(outer[a], outer[b], outer[c]),
                 lower = geometry::area_vector(inner[a], inner[b], inner[c]),
                 depth = (outer[a] - inner[a] + outer[b] - inner[b] + outer[c] - inner[c]) / 3;
  const double upright = upper.norm() * depth.norm();
  Openness from_below{upper.dot(depth) / upright, {}}, from_above{lower.dot(depth) / upright, {}};
  for (int i = 0; i < 3; ++i) {
    const Vector3d across = inner[corners[(i + 1) % 3]] - inner[corners[(i + 2) % 3]];
    from_below.by_inner[i] = -upper / (3 * upright);
    from_above.by_inner[i] = (across.cross(depth) - lower / 3) / upright;
  }
  return {from_below, from_above};
}

// Slides places on the surface that they make until no unit with inner nodes `share` of the way to them is
// nearly turned inside out: under a hanging breast, whose skin looks down and back, they have to lie higher
// than the skin does. Each unit moves its own by what it lacks, and where units disagree a place moves by the
// mean, each counted by what it lacks, so that one that lacks next to nothing does not count (position based
// dynamics: Mueller et al., J. Vis. Commun. Image R. 18, 2007, 109).
void slide_open(const geometry::ControlMesh& control, double share, std::vector<Vector3d>& places) {
  std::vector<Vector3d> inner(places.size());
  for (int round = 0; round < kMostSlides; ++round) {
    for (std::size_t v = 0; v < places.size(); ++v)
      inner[v] = control.outer[v] + share * (places[v] - control.outer[v]);
    std::vector<Vector3d> move(places.size(), Vector3d::Zero());
    std::vector<double> lacking(places.size(), 0);
    const std::vector<Vector3d> normals = geometry::vertex_normals(places, control.triangles);
    for (const Eigen::Vector3i& corners : control.triangles)
      for (const Openness& openness : openness_of(control.outer, inner, corners)) {
        const double lack = kOpen - openness.share;
        if (!(lack > 0)) continue;
        std::array<Vector3d, 3> along;
        double squares = 0, longest = 0;
        for (int i = 0; i < 3; ++i) {
          const Vector3d by = share * openness.by_inner[i];
          const Vector3d& normal = normals[corners[i]];
          along[i] =
              control.inner_fixed[corners[i]] ? Vector3d(0, 0, 0) : Vector3d(by - by.dot(normal) * normal);
          squares += along[i].squaredNorm();
          longest = std::max(longest, along[i].norm());
        }
        if (!(longest > 0)) continue;
        const double edge = (control.outer[corners[0]] - control.outer[corners[1]]).norm();
        const double by = std::min(lack / squares, kLongestSlide * edge / longest);
        for (int i = 0; i < 3; ++i) {
          move[corners[i]] += lack * by * along[i];
          lacking[corners[i]] += lack;
        }
      }
    for (std::size_t v = 0; v < places.size(); ++v)
      if (lacking[v] > 0) places[v] += move[v] / lacking[v];
  }
}

// Brings inner nodes nearer to their outer ones until none of their units is too thick, or they have all but
// come there.
template <typename TooThick>
void thin_units(geometry::ControlMesh& control, const TooThick& is_too_thick) {
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<char> too_thick(control.outer.size(), 0);
    for (const Eigen::Vector3i& corners : control.triangles)
      if (is_too_thick(corners))
        for (int i = 0; i < 3; ++i) too_thick[corners[i]] = 1;
    if (std::find(too_thick.begin(), too_thick.end(), 1) == too_thick.end()) return;
    for (std::size_t v = 0; v < too_thick.size(); ++v)
      if (too_thick[v]) control.inner[v] = control.outer[v] + kShrink * (control.inner[v] - control.outer[v]);
  }
}

}  // namespace

void place_on_bone(geometry::ControlMesh& control, const BoneRule& rule, double scale) {
  const std::vector<Vector3d> normals = smooth_normals(control);
  std::vector<Vector3d> bone(control.outer.size());
  for (std::size_t v = 0; v < bone.size(); ++v) bone[v] = control.outer[v] - rule.inset * normals[v];
  bend_least(control, bone);
  slide_open(control, scale * rule.share, bone);
  for (std::size_t v = 0; v < bone.size(); ++v) {
    const double depth = (control.outer[v] - bone[v]).dot(normals[v]);
    bone[v] -= std::max(0.0, rule.least - depth) * normals[v];
    control.inner[v] = control.outer[v] + scale * rule.share * (bone[v] - control.outer[v]);
  }
  thin_units(control, [&control](const Eigen::Vector3i& corners) {  // what no slide opened
    const auto [from_below, from_above] = openness_of(control.outer, control.inner, corners);
    return from_above.share <= 0 && from_below.share > 0;
  });
}

std::vector<double> thickness_of(const CushionRule& rule, const geometry::ControlMesh& control) {
  const std::string mirrored = rule.at.substr(0, rule.at.size() - 1) + "R";
  const Vector3d left = control.outer[control.node(rule.at)], right = control.outer[control.node(mirrored)];
  const auto bell = [](double distance, double width) {
    return std::exp(-distance * distance / (2 * width * width));
  };
  std::vector<double> thickness;
  for (const Vector3d& p : control.outer) {
    const double near = bell((p - left).norm(), rule.reach) + bell((p - right).norm(), rule.reach);
    const double aside = (p - (left + right) / 2).dot((left - right).normalized());
    const double depth = rule.depth + rule.more * std::min(1.0, near) * (1 - bell(aside, rule.cleft));
    thickness.push_back(rule.share * depth);
  }
  return thickness;
}

bool place_inner_nodes(geometry::ControlMesh& control, std::vector<double> thickness, const Skin& skin) {
  const std::vector<Vector3d> normals = smooth_normals(control);
  for (std::size_t v = 0; v < thickness.size(); ++v) {
    const Vector3d below = control.outer[v] - std::min(kBelowSkin, kBelowShare * thickness[v]) * normals[v];
    const auto far_side = skin.first_exit(below, -normals[v], thickness[v] / kShareOfBody);
    if (far_side) thickness[v] = std::min(thickness[v], kShareOfBody * (*far_side - below).norm());
  }
  for (std::size_t v = 0; v < thickness.size(); ++v)
    control.inner[v] = control.outer[v] - thickness[v] * normals[v];
  return thin_folded_units(control);
}

bool thin_folded_units(geometry::ControlMesh& control) {
  const auto facing = [&control](
                          const Eigen::Vector3i& k) {  // of the inner triangle, over the outer one's area
    const Vector3d outer =
        geometry::area_vector(control.outer[k[0]], control.outer[k[1]], control.outer[k[2]]);
    return geometry::area_vector(control.inner[k[0]], control.inner[k[1]], control.inner[k[2]]).dot(outer) /
           outer.squaredNorm();
  };
  thin_units(control, [&](const Eigen::Vector3i& k) { return facing(k) < kLeastVolumeShare; });
  return std::none_of(control.triangles.begin(), control.triangles.end(),
                      [&](const Eigen::Vector3i& k) { return facing(k) < 0; });
}

}  // namespace tensegric_fit::control_mesh
