#include "tensegric/fold_barrier.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tensegric_fit::tensegric {
namespace {

constexpr double kBegins = 0.7;  // s0
constexpr double kStiffness =
    0.3;  // times k and the mean edge: keeps triangles above half their area at 0.90
constexpr int kMostInversions = 60;  // 5 to 30: the curve begins with a square
constexpr double kFlatAtRest =
    1e-3;  // volume at rest / that of an upright unit, below which there is no barrier

// From the apex to the three corners.
struct Spokes {
  Eigen::Vector3d a, b, c;
};

Spokes spokes(const UnitVolume& unit, const Positions& x) {
  const auto& n = unit.nodes;
  const Eigen::Vector3d apex = (x[n[3]] + x[n[4]] + x[n[5]]) / 3;
  return {x[n[0]] - apex, x[n[1]] - apex, x[n[2]] - apex};
}

// Of the six nodes; the three of the apex have the same.
std::array<Eigen::Vector3d, 6> share_gradient(const UnitVolume& unit, const Spokes& s) {
  const Eigen::Vector3d a = s.b.cross(s.c) / unit.rest, b = s.c.cross(s.a) / unit.rest,
                        c = s.a.cross(s.b) / unit.rest, apex = -(a + b + c) / 3;
  return {a, b, c, apex, apex, apex};
}

struct Barrier {
  double energy, slope, curvature;  // by the share
};

Barrier barrier(const UnitVolume& unit, double share) {
  const double below = share - kBegins, log = std::log(share / kBegins);
  return {-unit.stiffness * below * below * log, -unit.stiffness * (2 * below * log + below * below / share),
          -unit.stiffness * (2 * log + 4 * below / share - below * below / (share * share))};
}

// The share below s0 at which the barrier's slope is -push. From below, where the curve is steeper, Newton's
// method on it comes near without overshooting.
double share_of_push(const UnitVolume& unit, double push) {
  const double wanted = push / unit.stiffness;
  double share = 2 * kBegins * kBegins /
                 (2 * kBegins + wanted + std::sqrt(wanted * (wanted + 4 * kBegins)));  // log left out
  for (int i = 0; i < kMostInversions; ++i) {
    const Barrier f = barrier(unit, share);
    if (!(f.curvature > 0)) break;
    const double by = -(f.slope + push) / f.curvature;
    share = std::min(share + by, kBegins);
    if (std::abs(by) <= 1e-15) break;
  }
  return share;
}

}  // namespace

std::vector<UnitVolume> unit_volumes(const Model& model, const std::vector<int>& free_index) {
  const Positions rest = model.rest_positions();
  std::vector<UnitVolume> units;
  const auto place = [&](const std::array<int, 6>& nodes, int side) {
    UnitVolume unit{nodes, 0, 0};
    bool moves = false;
    for (int node : unit.nodes) moves = moves || free_index[node] >= 0;
    const Spokes s = spokes(unit, rest);
    unit.rest = s.a.dot(s.b.cross(s.c));
    const double edge = ((s.a - s.b).norm() + (s.b - s.c).norm() + (s.c - s.a).norm()) / 3;
    const double upright = edge * edge * (s.a + s.b + s.c).norm() / 3;
    unit.stiffness = kStiffness * edge;
    if (moves && side * unit.rest > kFlatAtRest * upright) units.push_back(unit);
  };
  for (const auto& [a, b, c, d, e, f] : model.units()) {
    place({a, b, c, d, e, f}, 1);
    place({d, e, f, a, b, c}, -1);
  }
  return units;
}

double volume_share(const UnitVolume& unit, const Positions& x) {
  const Spokes s = spokes(unit, x);
  return s.a.dot(s.b.cross(s.c)) / unit.rest;
}

double fold_energy(const std::vector<UnitVolume>& units, const Positions& x) {
  double energy = 0;
  for (const UnitVolume& unit : units) {
    const double share = volume_share(unit, x);
    if (!(share > 0)) return std::numeric_limits<double>::infinity();
    if (share < kBegins) energy += barrier(unit, share).energy;
  }
  return energy;
}

void add_fold_gradient(const std::vector<UnitVolume>& units, const Positions& x,
                       const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const UnitVolume& unit : units) {
    const double share = volume_share(unit, x);
    if (share >= kBegins) continue;
    const double slope = barrier(unit, share).slope;
    const auto by_node = share_gradient(unit, spokes(unit, x));
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += slope * by_node[i];
    }
  }
}

std::vector<StraightPush> straight_pushes(const std::vector<UnitVolume>& units, const Positions& x,
                                          const Eigen::VectorXd& pushes) {
  std::vector<StraightPush> lines;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const double share = volume_share(units[i], x),
                 push = pushes.size() > 0 ? pushes[static_cast<Eigen::Index>(i)] : 0;
    if (push <= 0 && share >= kBegins) continue;
    const bool ends = push < 0 && push > barrier(units[i], share).slope;
    const double touched = ends ? kBegins : push > 0 ? share_of_push(units[i], push) : share;
    const Barrier f = barrier(units[i], touched);
    lines.push_back(
        {static_cast<int>(i), share, -f.slope, -f.slope - f.curvature * (share - touched), -f.curvature});
  }
  return lines;
}

void add_straight_difference(const std::vector<UnitVolume>& units, const Positions& x,
                             const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                             Eigen::VectorXd& gradient) {
  for (const StraightPush& line : lines) {
    const UnitVolume& unit = units[line.unit];
    const double push = line.share < kBegins ? -barrier(unit, line.share).slope : 0;
    const auto by_node = share_gradient(unit, spokes(unit, x));
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += (push - line.at_x) * by_node[i];
    }
  }
}

Eigen::VectorXd pushes_after(const std::vector<UnitVolume>& units, const Positions& x,
                             const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                             const Eigen::VectorXd& move) {
  Eigen::VectorXd pushes(static_cast<Eigen::Index>(lines.size()));
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const UnitVolume& unit = units[lines[k].unit];
    const auto by_node = share_gradient(unit, spokes(unit, x));
    double by = 0;
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) by += by_node[i].dot(move.segment<3>(3 * row));
    }
    pushes[static_cast<Eigen::Index>(k)] = lines[k].at_x + lines[k].slope * by;
  }
  return pushes;
}

void add_fold_hessian(const std::vector<UnitVolume>& units, const Positions& x,
                      const std::vector<StraightPush>& lines, const std::vector<int>& free_index,
                      NodeMatrix& hessian, double whole) {
  for (const StraightPush& line : lines) {
    const UnitVolume& unit = units[line.unit];
    const Spokes s = spokes(unit, x);
    const auto by_node = share_gradient(unit, s);
    // The share's own second derivative, by pairs of spokes: that by a is b x c.
    const double scale = -whole * line.push / unit.rest;
    const Eigen::Matrix3d ab = -scale * cross_matrix(s.c), bc = -scale * cross_matrix(s.a),
                          ca = -scale * cross_matrix(s.b);
    const Eigen::Matrix3d to_apex[] = {(ca - ab) / 3, (ab - bc) / 3, (bc - ca) / 3};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j <= i; ++j) {
        Eigen::Matrix3d block = -line.slope * by_node[i] * by_node[j].transpose();
        if (i >= 3 && j < 3) block += to_apex[j].transpose();
        if (i == 1 && j == 0) block += ab.transpose();
        if (i == 2 && j == 1) block += bc.transpose();
        if (i == 2 && j == 0) block += ca;
        hessian.add(free_index[unit.nodes[i]], free_index[unit.nodes[j]], block);
      }
    }
  }
}

}  // namespace tensegric_fit::tensegric
