#include "reconstruction/voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Cell = std::pair<std::int64_t, int>;  // key, point

/// By key, equal keys in the order they have: digit by digit, the least significant first. std::sort takes
/// some 40 times as long (40 ms for 200,000 points), and each scan is sorted several times.
void sort_by_key(std::vector<Cell>& cells) {
  constexpr int kBits = 11;
  constexpr std::int64_t kDigit = (1 << kBits) - 1;
  std::int64_t highest = 0;
  for (const Cell& cell : cells) highest = std::max(highest, cell.first);
  std::vector<Cell> sorted(cells.size());
  for (int shift = 0; shift < 63 && highest >> shift > 0; shift += kBits) {
    std::array<std::size_t, kDigit + 2> begin{};
    for (const Cell& cell : cells) ++begin[(cell.first >> shift & kDigit) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const Cell& cell : cells) sorted[begin[cell.first >> shift & kDigit]++] = cell;
    cells.swap(sorted);
  }
}

}  // namespace

VoxelGrid::VoxelGrid(const std::vector<Eigen::Vector3d>& points, double cell_size) {
  const auto box = geometry::bounding_box(points);
  const auto index = [&](const Eigen::Vector3d& p, int axis) {
    return static_cast<std::int64_t>((p[axis] - box[0][axis]) / cell_size) + 1;  // an empty cell all round
  };
  row_ = index(box[1], 0) + 2;
  layer_ = row_ * (index(box[1], 1) + 2);
  std::vector<Cell> cells(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& p = points[i];
    cells[i] = {index(p, 2) * layer_ + index(p, 1) * row_ + index(p, 0), static_cast<int>(i)};
  }
  sort_by_key(cells);
  order_.reserve(cells.size());
  for (const auto& [key, point] : cells) {
    if (keys_.empty() || keys_.back() != key) {
      keys_.push_back(key);
      first_.push_back(static_cast<int>(order_.size()));
    }
    order_.push_back(point);
  }
  first_.push_back(static_cast<int>(order_.size()));
}

void VoxelGrid::around(int cell, std::vector<int>& cells) const {
  cells.clear();
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      const std::int64_t middle = keys_[cell] + dz * layer_ + dy * row_;
      auto found = std::lower_bound(keys_.begin(), keys_.end(), middle - 1);
      for (; found != keys_.end() && *found <= middle + 1; ++found)
        cells.push_back(static_cast<int>(found - keys_.begin()));
    }
  }
}

}  // namespace tensegric_fit::reconstruction
