#include "tffd/triangle_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tensegric_fit::tffd {
namespace {

// However unlike in size the triangles are, the grid stays this small.
constexpr double kMostCells = 200000;
// Cells, and triangles in cells: equal triangles lie in 200 cells at most, a few far larger ones in all.
constexpr double kLeastRoom = 4 * kMostCells, kRoomPerTriangle = 512, kWider = 1.25;

struct Sphere {
  Eigen::Vector3d centre;
  double radius;
};

// Where the triangle is not farther_than(reach * radius), and a little for rounding.
Sphere reach_of(const Frame& frame, double reach) {
  return {frame.centroid, (reach + 1.5) * frame.radius * (1 + 1e-9)};
}

bool touches(const Sphere& sphere, const Eigen::Array3d& low, double cell) {
  const Eigen::Array3d centre = sphere.centre.array();
  return (centre - centre.max(low).min(low + cell)).matrix().squaredNorm() <= sphere.radius * sphere.radius;
}

}  // namespace

TriangleGrid::TriangleGrid(const std::vector<Frame>& frames, double reach) {
  low_.setConstant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low_;
  double mean = 0;
  for (const Frame& frame : frames) {
    const Sphere sphere = reach_of(frame, reach);
    low_ = low_.cwiseMin((sphere.centre.array() - sphere.radius).matrix());
    high = high.cwiseMax((sphere.centre.array() + sphere.radius).matrix());
    mean += sphere.radius / static_cast<double>(frames.size());
  }
  const Eigen::Array3d size = (high - low_).array();
  cell_ = std::max(mean / 2, std::cbrt(size.prod() / kMostCells));
  const double room = std::max(kLeastRoom, kRoomPerTriangle * static_cast<double>(frames.size()));
  // First and last cell of the box round what a triangle reaches.
  const auto cells_of = [&](const Sphere& sphere) -> std::array<Eigen::Array3i, 2> {
    const Eigen::Array3d offset = (sphere.centre - low_).array();
    return {((offset - sphere.radius) / cell_).floor().cast<int>().max(0),
            ((offset + sphere.radius) / cell_).floor().cast<int>().min(counts_ - 1)};
  };
  const auto has_room = [&] {
    if (((size / cell_).floor() + 1).prod() > room) return false;
    counts_ = (size / cell_).floor().cast<int>() + 1;
    double entries = 0;
    for (std::size_t t = 0; t < frames.size() && entries <= room; ++t) {
      const auto [first, last] = cells_of(reach_of(frames[t], reach));
      entries += (last - first + 1).cast<double>().prod();
    }
    return entries <= room;
  };
  while (!has_room()) cell_ *= kWider;

  // Twice over all triangles and the cells that they reach: first to count, then to fill.
  const auto for_each_cell = [&](const auto& visit) {
    for (std::size_t t = 0; t < frames.size(); ++t) {
      const Sphere sphere = reach_of(frames[t], reach);
      const auto [first, last] = cells_of(sphere);
      for (int z = first[2]; z <= last[2]; ++z)
        for (int y = first[1]; y <= last[1]; ++y)
          for (int x = first[0]; x <= last[0]; ++x)
            if (touches(sphere, low_.array() + cell_ * Eigen::Array3d(x, y, z), cell_))
              visit(static_cast<int>(t), (z * counts_[1] + y) * counts_[0] + x);
    }
  };
  starts_.assign(static_cast<std::size_t>(counts_.prod()) + 1, 0);
  for_each_cell([&](int, int cell) { ++starts_[cell + 1]; });
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  triangles_.resize(static_cast<std::size_t>(starts_.back()));
  std::vector<int> filled(starts_.begin(), starts_.end() - 1);
  for_each_cell([&](int triangle, int cell) { triangles_[filled[cell]++] = triangle; });
}

TriangleGrid::Range TriangleGrid::near(const Eigen::Vector3d& q) const {
  const Eigen::Array3d at = ((q - low_).array() / cell_).floor();
  const int* const all = triangles_.data();
  if (!(at >= 0).all() || !(at < counts_.cast<double>()).all()) return {all, all};
  const Eigen::Array3i index = at.cast<int>();
  const int cell = (index[2] * counts_[1] + index[1]) * counts_[0] + index[0];
  return {all + starts_[cell], all + starts_[cell + 1]};
}

}  // namespace tensegric_fit::tffd
