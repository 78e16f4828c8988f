#include "tensegric/unit_pressure.hpp"

#include <Eigen/Geometry>

namespace tensegric_fit::tensegric {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Corners = std::array<Vector3d, 6>;

// The unit's surface, oriented outward: with weight 1 its two triangles, with 1/2 both foldings of each side.
struct Face {
  int a, b, c;
  double weight;
};
constexpr std::array<Face, 14> kFaces = {{{0, 1, 2, 1},
                                          {5, 4, 3, 1},
                                          {0, 3, 4, 0.5},
                                          {0, 4, 1, 0.5},
                                          {0, 3, 1, 0.5},
                                          {3, 4, 1, 0.5},
                                          {1, 4, 5, 0.5},
                                          {1, 5, 2, 0.5},
                                          {1, 4, 2, 0.5},
                                          {4, 5, 2, 0.5},
                                          {2, 5, 3, 0.5},
                                          {2, 3, 0, 0.5},
                                          {2, 5, 0, 0.5},
                                          {5, 3, 0, 0.5}}};

Corners corners_of(const UnitPressure& unit, const Positions& x) {
  Corners corners;
  for (int i = 0; i < 6; ++i) corners[i] = x[unit.nodes[i]] - unit.origin;
  return corners;
}

Corners gradient_of(const Corners& p) {
  Corners g;
  g.fill(Vector3d::Zero());
  for (const Face& f : kFaces) {
    g[f.a] += f.weight / 6 * p[f.b].cross(p[f.c]);
    g[f.b] += f.weight / 6 * p[f.c].cross(p[f.a]);
    g[f.c] += f.weight / 6 * p[f.a].cross(p[f.b]);
  }
  return g;
}

double strain_of(const UnitPressure& unit, const Corners& corners) {
  return unit_volume(corners) / unit.rest - 1;
}

}  // namespace

double unit_volume(const Corners& corners) {
  double volume = 0;
  for (const Face& f : kFaces) volume += f.weight / 6 * corners[f.a].dot(corners[f.b].cross(corners[f.c]));
  return volume;
}

std::vector<UnitPressure> unit_pressures(const Model& model, const std::vector<int>& free_index) {
  std::vector<UnitPressure> units;
  if (model.options.volume_stiffness == 0) return units;
  const Positions rest = model.rest_positions();
  std::size_t index = 0;
  for (const std::array<int, 6>& nodes : model.units()) {
    const double times = model.times[index++ % model.times.size()];
    UnitPressure unit{nodes, Vector3d::Zero(), 0, times * model.options.volume_stiffness * model.tissue};
    bool moves = false;
    for (int node : unit.nodes) {
      unit.origin += rest[node] / 6;
      moves = moves || free_index[node] >= 0;
    }
    const Corners corners = corners_of(unit, rest);
    unit.rest = unit_volume(corners);
    const double area = geometry::area_vector(corners[0], corners[1], corners[2]).norm() / 2;
    const double depth = ((corners[0] - corners[3]).norm() + (corners[1] - corners[4]).norm() +
                          (corners[2] - corners[5]).norm()) /
                         3;
    if (moves && unit.rest > kFlatUnit * area * depth) units.push_back(unit);
  }
  return units;
}

double pressure_energy(const std::vector<UnitPressure>& units, const Positions& x) {
  double energy = 0;
  for (const UnitPressure& unit : units) {
    const double strain = strain_of(unit, corners_of(unit, x));
    energy += unit.stiffness * unit.rest * strain * strain / 2;
  }
  return energy;
}

void add_pressure_gradient(const std::vector<UnitPressure>& units, const Positions& x,
                           const std::vector<int>& free_index, Eigen::VectorXd& gradient) {
  for (const UnitPressure& unit : units) {
    const Corners corners = corners_of(unit, x), by_node = gradient_of(corners);
    const double pressure = unit.stiffness * strain_of(unit, corners);
    for (int i = 0; i < 6; ++i) {
      const int row = free_index[unit.nodes[i]];
      if (row >= 0) gradient.segment<3>(3 * row) += pressure * by_node[i];
    }
  }
}

void add_pressure_hessian(const std::vector<UnitPressure>& units, const Positions& x,
                          const std::vector<int>& free_index, NodeMatrix& hessian, double whole) {
  for (const UnitPressure& unit : units) {
    const Corners corners = corners_of(unit, x), by_node = gradient_of(corners);
    const double pressure = whole * unit.stiffness * strain_of(unit, corners);
    std::array<std::array<Matrix3d, 6>, 6> second;  // the volume's, lower triangle
    for (auto& row : second) row.fill(Matrix3d::Zero());
    // By a, then b, of a . (b x c): -cross_matrix(c).
    const auto add = [&](int a, int b, const Vector3d& by) {
      if (a > b)
        second[a][b] -= cross_matrix(by);
      else
        second[b][a] += cross_matrix(by);
    };
    for (const Face& f : kFaces) {
      add(f.a, f.b, f.weight / 6 * corners[f.c]);
      add(f.b, f.c, f.weight / 6 * corners[f.a]);
      add(f.c, f.a, f.weight / 6 * corners[f.b]);
    }
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j)
        hessian.add(
            free_index[unit.nodes[i]], free_index[unit.nodes[j]],
            unit.stiffness / unit.rest * by_node[i] * by_node[j].transpose() + pressure * second[i][j]);
  }
}

}  // namespace tensegric_fit::tensegric
