#include "reconstruction/sensor_patches.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel_for.hpp"
#include "geometry/principal_axes.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Eigen::Vector3d;

constexpr int kFewestInPatch = 4;     // points of a sensor in a patch
constexpr double kFlat = 0.1;         // least variance over the next
constexpr double kPatchFacing = 0.5;  // cosine between the normals of a patch
constexpr double kRidge = 1e-6;       // of a patch's surface

class Patches {
 public:
  Patches(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals,
          const std::vector<int>& sensor_of, int sensors, double radius, int step)
      : points_(points),
        normals_(normals),
        sensor_of_(sensor_of),
        sensors_(sensors),
        radius_(radius),
        step_(step),
        grid_(points, radius) {}

  SensorPatches all() const {
    std::array<SensorPatches, 2> of_half;
    geometry::parallel_for(grid_.cell_count(), [&](std::size_t begin, std::size_t end, int half) {
      std::vector<int> near;
      for (std::size_t c = begin; c < end; c += step_) add_patch(static_cast<int>(c), near, of_half[half]);
    });
    SensorPatches& result = of_half[0];
    for (Patch patch : of_half[1].patches) {
      patch.begin += result.sheets.size();
      patch.end += result.sheets.size();
      result.patches.push_back(patch);
    }
    result.sheets.insert(result.sheets.end(), of_half[1].sheets.begin(), of_half[1].sheets.end());
    return std::move(result);
  }

 private:
  void add_patch(int cell, std::vector<int>& near, SensorPatches& result) const {
    Patch patch;
    patch.centre = Vector3d::Zero();
    for (int i = grid_.begin(cell); i < grid_.end(cell); ++i) patch.centre += points_[grid_.order()[i]];
    patch.centre /= grid_.end(cell) - grid_.begin(cell);
    near_points(cell, patch.centre, near);
    if (!normals_.empty()) keep_facing(grid_.order()[grid_.begin(cell)], near);
    const std::vector<int> count = seen_by(near);
    if (std::count_if(count.begin(), count.end(), [](int n) { return n >= kFewestInPatch; }) >= 2 &&
        lay(near, patch))
      add_sheets(near, count, patch, result);
  }

  void near_points(int cell, const Vector3d& centre, std::vector<int>& near) const {
    std::vector<int> cells;
    grid_.around(cell, cells);
    near.clear();
    for (int c : cells) {
      for (int i = grid_.begin(c); i < grid_.end(c); ++i) {
        const int p = grid_.order()[i];
        if (sensor_of_[p] >= 0 && (points_[p] - centre).squaredNorm() <= radius_ * radius_) near.push_back(p);
      }
    }
  }

  /// Those that face the way of one of them.
  void keep_facing(int one, std::vector<int>& near) const {
    near.erase(std::remove_if(near.begin(), near.end(),
                              [&](int i) { return !(normals_[i].dot(normals_[one]) > kPatchFacing); }),
               near.end());
  }

  std::vector<int> seen_by(const std::vector<int>& near) const {
    std::vector<int> count(sensors_);
    for (int i : near) ++count[sensor_of_[i]];
    return count;
  }

  /// The patch's axes; false where it has none.
  bool lay(const std::vector<int>& near, Patch& patch) const {
    if (!normals_.empty()) {  // sheets that are far apart have no plane
      Vector3d sum = Vector3d::Zero();
      for (int i : near) sum += normals_[i];
      patch.normal = sum.normalized();
      patch.x = patch.normal.unitOrthogonal();
      patch.y = patch.normal.cross(patch.x);
      return true;
    }
    const auto axes = geometry::principal_axes(points_, near, patch.centre);
    if (axes.eigenvalues()[0] > kFlat * axes.eigenvalues()[1]) return false;
    patch.normal = axes.eigenvectors().col(0);
    patch.x = axes.eigenvectors().col(1);
    patch.y = axes.eigenvectors().col(2);
    return true;
  }

  void add_sheets(const std::vector<int>& near, const std::vector<int>& count, Patch& patch,
                  SensorPatches& result) const {
    std::vector<int> sheet_of(sensors_, -1);
    patch.begin = result.sheets.size();
    for (int s = 0; s < sensors_; ++s) {
      if (count[s] < kFewestInPatch) continue;
      sheet_of[s] = static_cast<int>(result.sheets.size());
      result.sheets.push_back(
          {s, static_cast<double>(count[s]), Eigen::Matrix<double, 6, 6>::Zero(), Surface::Zero(), 0});
    }
    patch.end = result.sheets.size();
    for (int i : near) {
      if (sheet_of[sensor_of_[i]] < 0) continue;
      const Vector3d d = points_[i] - patch.centre;
      const double u = patch.x.dot(d) / radius_, v = patch.y.dot(d) / radius_;
      Surface terms;
      terms << 1, u, v, u * u, u * v, v * v;
      SensorPatch& sheet = result.sheets[sheet_of[sensor_of_[i]]];
      sheet.gram += terms * terms.transpose();
      const double height = patch.normal.dot(d);
      sheet.heights += height * terms;
      sheet.squares += height * height;
    }
    result.patches.push_back(patch);
  }

  const std::vector<Vector3d>&points_, &normals_;
  const std::vector<int>& sensor_of_;
  int sensors_;
  double radius_;
  int step_;
  VoxelGrid grid_;
};

}  // namespace

SensorPatches sensor_patches_of(const std::vector<Vector3d>& points, const std::vector<Vector3d>& normals,
                                const std::vector<int>& sensor_of, int sensors, double radius, int step) {
  return Patches(points, normals, sensor_of, sensors, radius, step).all();
}

void PatchEquations::set(const SensorPatches& all, const Patch& patch) {
  std::vector<Surface> heights;
  for (std::size_t i = patch.begin; i < patch.end; ++i) heights.push_back(all.sheets[i].heights);
  set(all, patch, heights, std::vector<double>(heights.size(), 1).data());
}

void PatchEquations::set(const SensorPatches& all, const Patch& patch, const std::vector<Surface>& heights,
                         const double* weights) {
  sheets_ = &all.sheets[patch.begin];
  const std::size_t count = patch.end - patch.begin;
  weights_.assign(weights, weights + count);
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  Surface sum = Surface::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    gram += weights[i] * sheets_[i].gram;
    sum += weights[i] * heights[i];
  }
  gram.diagonal().array() += kRidge * gram.trace();
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> solver(gram);
  surface_ = solver.solve(sum);
  heights_ = heights;
  left_.resize(count);
  solved_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    left_[i] = heights[i] - sheets_[i].gram * surface_;
    solved_[i] = weights[i] * solver.solve(sheets_[i].gram.leftCols<3>());
  }
}

Eigen::Matrix3d PatchEquations::squares(std::size_t i, std::size_t j) const {
  Eigen::Matrix3d result = -weights_[i] * sheets_[i].gram.topRows<3>() * solved_[j];
  if (i == j) result += weights_[i] * sheets_[i].gram.topLeftCorner<3, 3>();
  return result;
}

double PatchEquations::thickness(std::size_t i) const {
  const SensorPatch& sheet = sheets_[i];
  const double sum =
      sheet.squares - surface_.dot(heights_[i] + left_[i]) - left_[i][0] * left_[i][0] / sheet.count;
  return std::sqrt(std::max(0.0, sum) / sheet.count);
}

Eigen::Vector3d PatchEquations::right(std::size_t i) const {
  return -weights_[i] * left_[i].head<3>();
}

double PatchEquations::difference(std::size_t i) const {
  return std::abs(left_[i][0]) / sheets_[i].count;
}

}  // namespace tensegric_fit::reconstruction
