#include "reconstruction/body_points.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/percentile.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kNeighbourhood = 0.01;  // m, cell in which a point should have company
// Times as many points near most points as in most cells: F0's, F2's and two training scans have 1.1 to 2.6,
// the vertices of F0's and F1's meshes, which are fine in the face, 20. With 2 those meshes do as well.
constexpr int kCrowded = 4;
constexpr double kLink = 0.03;  // m, cell of the clustering: bridges gaps of 30 to 60 mm

Points points_at(const Points& points, const std::vector<int>& indices) {
  Points result(indices.size());
  std::transform(indices.begin(), indices.end(), result.begin(), [&](int i) { return points[i]; });
  return result;
}

/// Number of the connected cluster of each cell.
std::vector<int> clusters_of(const VoxelGrid& grid) {
  std::vector<int> cluster(grid.cell_count(), -1), front, cells;
  int count = 0;
  for (int seed = 0; seed < grid.cell_count(); ++seed) {
    if (cluster[seed] >= 0) continue;
    cluster[seed] = count;
    front.assign(1, seed);
    while (!front.empty()) {
      const int cell = front.back();
      front.pop_back();
      grid.around(cell, cells);
      for (int other : cells) {
        if (cluster[other] >= 0) continue;
        cluster[other] = count;
        front.push_back(other);
      }
    }
    ++count;
  }
  return cluster;
}

}  // namespace

std::vector<int> without_stray(const Points& points) {
  if (points.empty()) return {};
  const VoxelGrid grid(points, kNeighbourhood);
  std::vector<int> company(grid.cell_count()), cells, companies;
  for (int c = 0; c < grid.cell_count(); ++c) {
    grid.around(c, cells);
    for (int other : cells) company[c] += grid.end(other) - grid.begin(other);
    companies.insert(companies.end(), grid.end(c) - grid.begin(c), company[c]);
  }
  // Of the points, as stray ones may have more cells than she has; but where most points are crowded on a
  // little skin, as a mesh's vertices on a face, of the cells.
  const int usual = std::min(geometry::median(companies), kCrowded * geometry::median(company));
  const int enough = std::max(3, usual / 10);
  std::vector<int> kept;
  for (int c = 0; c < grid.cell_count(); ++c)
    if (company[c] >= enough)
      kept.insert(kept.end(), grid.order().begin() + grid.begin(c), grid.order().begin() + grid.end(c));
  return kept;
}

std::vector<std::vector<int>> things_in(const Points& points) {
  const VoxelGrid grid(points, kLink);
  const std::vector<int> cluster = clusters_of(grid);
  std::vector<std::vector<int>> things(*std::max_element(cluster.begin(), cluster.end()) + 1);
  std::vector<int> of_point(points.size());
  for (int c = 0; c < grid.cell_count(); ++c)
    for (int i = grid.begin(c); i < grid.end(c); ++i) of_point[grid.order()[i]] = cluster[c];
  for (std::size_t i = 0; i < points.size(); ++i) things[of_point[i]].push_back(static_cast<int>(i));
  std::stable_sort(things.begin(), things.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return things;
}

std::vector<int> body_points(const Points& points, const std::function<bool(const Points&)>& may_be_her) {
  if (points.empty()) return {};
  const std::vector<int> dense = without_stray(points);
  if (dense.empty()) return {};
  std::vector<std::vector<int>> things = things_in(points_at(points, dense));
  for (std::vector<int>& thing : things)
    for (int& i : thing) i = dense[i];
  const auto her = std::find_if(things.begin(), things.end(), [&](const std::vector<int>& thing) {
    return may_be_her(points_at(points, thing));
  });
  return her == things.end() ? things.front() : *her;
}

}  // namespace tensegric_fit::reconstruction
