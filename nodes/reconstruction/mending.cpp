#include "reconstruction/mending.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/percentile.hpp"
#include "geometry/point_tree.hpp"
#include "geometry/triangle_mesh.hpp"
#include "reconstruction/sensor_patches.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Entries = std::vector<Eigen::Triplet<double>>;

constexpr std::array<double, 3> kRadii = {0.025, 0.020, 0.015};  // m, of the patches, pass by pass
constexpr int kSearchStep = 3, kMendStep = 1;                    // cells from patch to patch
constexpr double kLeastDifference = 0.00075;  // m, of a sheet from the mean of those that part
constexpr double kOverUsual = 4;              // usual differences
constexpr double kFuzzySheet = 2.2;   // usual thicknesses; where a sheet is thicker there are fingers or hair
constexpr double kLinked = 0.07;      // m, around a patch that parts,
constexpr int kFewestLinked = 4;      // with so many that do
constexpr double kShiftReach = 0.12;  // m, of shifts beyond the patches that part
constexpr double kShiftSpacing = 0.05;  // m, of the places whose shifts are sought
constexpr double kStiffness = 2;        // points that hold neighbouring places together
constexpr double kPrior = 0.05;         // points that hold a place still
constexpr int kMostSteps = 500;         // of conjugate gradients; 20 to 30 are usual
constexpr double kTolerance = 1e-6;     // of the solution, relative
constexpr double kLowestMended = 0.10,
                 kHighestMended = 0.85;  // toes end below, in m; the neck here, in heights

/// Middles of the patches whose sheets part, where many do.
Points parted(const SensorPatches& all, double height) {
  std::vector<double> differences, thicknesses;  // a sheet
  PatchEquations equations;
  for (const Patch& patch : all.patches) {
    equations.set(all, patch);
    for (std::size_t i = 0; i < patch.end - patch.begin; ++i) {
      differences.push_back(equations.difference(i));
      thicknesses.push_back(equations.thickness(i));
    }
  }
  if (differences.empty()) return {};
  const auto largest = [](const std::vector<double>& of, const Patch& patch) {
    return *std::max_element(of.begin() + patch.begin, of.begin() + patch.end);
  };
  const double least = std::max(kLeastDifference, kOverUsual * geometry::percentile(differences, 0.5)),
               thickest = kFuzzySheet * geometry::percentile(thicknesses, 0.5);
  Points found, result;
  for (const Patch& patch : all.patches)
    if (patch.centre.z() > kLowestMended && patch.centre.z() < kHighestMended * height &&
        largest(differences, patch) > least && largest(thicknesses, patch) < thickest)
      found.push_back(patch.centre);
  std::copy_if(found.begin(), found.end(), std::back_inserter(result), [&](const Vector3d& p) {
    return std::count_if(found.begin(), found.end(),
                         [&](const Vector3d& q) { return (p - q).norm() < kLinked; }) >= kFewestLinked;
  });
  return result;
}

/// Those of the points that are near to any of the places.
std::vector<int> near_to(const Points& places, const Points& points) {
  const geometry::PointTree tree(places);
  std::vector<int> near;
  for (std::size_t i = 0; i < points.size(); ++i)
    if ((points[i] - places[tree.nearest(points[i])]).norm() < kShiftReach)
      near.push_back(static_cast<int>(i));
  return near;
}

/// Shifts of each sensor at the places of a lattice round the points that it sees, and between them.
class Field {
 public:
  Field(const Points& points, const std::vector<int>& sensor_of) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (sensor_of[i] >= 0)
        for (int corner = 0; corner < 8; ++corner) numbers_[key(cell(points[i]), corner, sensor_of[i])] = 0;
    int next = 0;
    for (auto& [place, number] : numbers_) number = next++;
    shifts_ = Eigen::VectorXd::Zero(3 * next);
  }

  Vector3d shift(const Vector3d& p, int sensor) const {
    Vector3d sum = Vector3d::Zero();
    for_places(p, sensor, [&](int number, double share) { sum += share * shifts_.segment<3>(3 * number); });
    return sum;
  }

  /// The shifts after which the sheets of each patch lie best on one surface.
  void bring_together(const SensorPatches& all) {
    Entries of_sheets, of_shifts, held;  // how sheets' heights hold each other, and follow the shifts
    const int sheets = static_cast<int>(all.sheets.size());
    Eigen::VectorXd right(sheets);
    PatchEquations equations;
    for (const Patch& patch : all.patches) {
      equations.set(all, patch);
      const int first = static_cast<int>(patch.begin), count = static_cast<int>(patch.end) - first;
      for (int i = 0; i < count; ++i) {
        right[first + i] = equations.right(i)[0];
        for (int j = 0; j < count; ++j)
          of_sheets.emplace_back(first + i, first + j, equations.squares(i, j)(0, 0));
        for_places(patch.centre, all.sheets[first + i].sensor, [&](int number, double share) {
          for (int axis = 0; axis < 3; ++axis)
            of_shifts.emplace_back(first + i, 3 * number + axis, share * patch.normal[axis]);
        });
      }
    }
    add_stiffness(held);
    const int unknowns = static_cast<int>(shifts_.size());
    SparseMatrix follow(sheets, unknowns), hold(sheets, sheets), stiffness(unknowns, unknowns);
    follow.setFromTriplets(of_shifts.begin(), of_shifts.end());
    hold.setFromTriplets(of_sheets.begin(), of_sheets.end());
    stiffness.setFromTriplets(held.begin(), held.end());
    const SparseMatrix back = follow.transpose(), held_shifts = hold * follow;
    const SparseMatrix matrix = SparseMatrix(back * held_shifts) + stiffness;
    Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver;
    solver.setMaxIterations(kMostSteps);
    solver.setTolerance(kTolerance);
    shifts_ = solver.compute(matrix).solve(back * right);
  }

 private:
  using Key = std::array<int, 4>;  // x, y, z, sensor

  static Eigen::Array3i cell(const Vector3d& p) { return (p.array() / kShiftSpacing).floor().cast<int>(); }
  static Key key(const Eigen::Array3i& low, int corner, int sensor) {
    return {low.x() + (corner & 1), low.y() + (corner >> 1 & 1), low.z() + (corner >> 2 & 1), sensor};
  }

  /// Calls use(number, share) for the places that a sensor's shift at a point is made of.
  template <typename Use>
  void for_places(const Vector3d& p, int sensor, const Use& use) const {
    const Eigen::Array3i low = cell(p);
    const Eigen::Array3d at = p.array() / kShiftSpacing - low.cast<double>();
    for (int corner = 0; corner < 8; ++corner) {
      const auto found = numbers_.find(key(low, corner, sensor));
      if (found == numbers_.end()) continue;
      double share = 1;
      for (int axis = 0; axis < 3; ++axis) share *= corner >> axis & 1 ? at[axis] : 1 - at[axis];
      use(found->second, share);
    }
  }

  /// Neighbours hold each other; a place at the lattice's edge is held by those that stay where they are.
  void add_stiffness(Entries& entries) const {
    const auto add = [&](int a, int b, double value) {
      for (int axis = 0; axis < 3; ++axis) entries.emplace_back(3 * a + axis, 3 * b + axis, value);
    };
    for (const auto& [place, number] : numbers_) {
      add(number, number, kPrior);
      for (int axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          Key next = place;
          next[axis] += step;
          add(number, number, kStiffness);
          const auto found = numbers_.find(next);
          if (found != numbers_.end()) add(number, found->second, -kStiffness);
        }
      }
    }
  }

  std::map<Key, int> numbers_;
  Eigen::VectorXd shifts_;
};

}  // namespace

bool mend_fractures(Points& points, const Points& normals, const std::vector<int>& sensor_of) {
  const int sensors = sensor_of.empty() ? 0 : *std::max_element(sensor_of.begin(), sensor_of.end()) + 1;
  if (sensors < 2) return false;
  const Points places = parted(sensor_patches_of(points, normals, sensor_of, sensors, kRadii[0], kSearchStep),
                               geometry::bounding_box(points)[1].z());
  if (places.empty()) return false;
  const std::vector<int> near = near_to(places, points);
  Points moved, facing;
  std::vector<int> seen_by;
  for (int i : near) {
    moved.push_back(points[i]);
    facing.push_back(normals[i]);
    seen_by.push_back(sensor_of[i]);
  }
  for (double radius : kRadii) {
    Field field(moved, seen_by);
    field.bring_together(sensor_patches_of(moved, facing, seen_by, sensors, radius, kMendStep));
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (seen_by[i] >= 0) moved[i] += field.shift(moved[i], seen_by[i]);
  }
  for (std::size_t i = 0; i < near.size(); ++i) points[near[i]] = moved[i];
  return true;
}

}  // namespace tensegric_fit::reconstruction
