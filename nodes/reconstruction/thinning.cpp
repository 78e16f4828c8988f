#include "reconstruction/thinning.hpp"

#include <algorithm>
#include <array>

#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using geometry::PointCloud;

constexpr double kBendSurroundings = 0.01;                       // m; cubes whose 27 show how the skin bends
constexpr std::array<double, 3> kCube = {0.0025, 0.005, 0.010};  // m
constexpr std::array<int, 3> kTimes = {3, 2, 1};                 // that a mean of each cube counts
constexpr double kOneSide = 0.8;  // length of the mean normal of a cube; below, it holds two sides of a gap
constexpr std::array<double, 2> kAgreement = {0.7, 0.9};  // length of the mean normal that parts the cubes

/// Adds the mean point and normal of every cube.
void add_means(const PointCloud& cloud, double cube, PointCloud& means) {
  if (cloud.points.empty()) return;
  const VoxelGrid grid(cloud.points, cube);
  for (int c = 0; c < grid.cell_count(); ++c) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    for (int i = grid.begin(c); i < grid.end(c); ++i) {
      point += cloud.points[grid.order()[i]];
      normal += cloud.normals[grid.order()[i]];
    }
    if (normal.norm() < kOneSide * (grid.end(c) - grid.begin(c))) {
      for (int i = grid.begin(c); i < grid.end(c); ++i) {
        means.points.push_back(cloud.points[grid.order()[i]]);
        means.normals.push_back(cloud.normals[grid.order()[i]]);
      }
      continue;
    }
    means.points.push_back(point / (grid.end(c) - grid.begin(c)));
    means.normals.push_back(normal.normalized());
  }
}

}  // namespace

PointCloud merged(const PointCloud& cloud, double cube, bool by_sensor) {
  const bool oriented = !cloud.normals.empty(), sensed = !cloud.sensor.empty();
  const VoxelGrid grid(cloud.points, cube);
  std::vector<int> order = grid.order();
  const auto same = [&](int a, int b) { return !sensed || cloud.sensor[a] == cloud.sensor[b]; };
  PointCloud means;
  for (int c = 0; c < grid.cell_count(); ++c) {
    const auto first = order.begin() + grid.begin(c), last = order.begin() + grid.end(c);
    const bool apart = by_sensor && sensed;
    if (apart) std::stable_sort(first, last, [&](int a, int b) { return cloud.sensor[a] < cloud.sensor[b]; });
    for (auto from = first; from != last;) {
      const auto other = std::find_if(from, last, [&](int i) { return !same(i, *from); });
      const auto to = apart ? other : last;
      Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
      for (auto i = from; i != to; ++i) {
        point += cloud.points[*i];
        if (oriented) normal += cloud.normals[*i];
      }
      means.points.push_back(point / static_cast<double>(to - from));
      if (oriented) means.normals.push_back(normal.squaredNorm() > 0 ? normal.normalized() : normal);
      if (sensed) means.sensor.push_back(other == to ? cloud.sensor[*from] : -1);
      from = to;
    }
  }
  return means;
}

PointCloud thinned(const PointCloud& cloud, const std::array<double, 2>& fine) {
  const VoxelGrid grid(cloud.points, kBendSurroundings);
  std::array<PointCloud, kCube.size()> by_cube;
  std::vector<Eigen::Vector3d> sum(grid.cell_count(), Eigen::Vector3d::Zero());
  for (int c = 0; c < grid.cell_count(); ++c)
    for (int i = grid.begin(c); i < grid.end(c); ++i) sum[c] += cloud.normals[grid.order()[i]];
  std::vector<int> around;
  for (int c = 0; c < grid.cell_count(); ++c) {
    grid.around(c, around);
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    int count = 0;
    for (int a : around) {
      normal += sum[a];
      count += grid.end(a) - grid.begin(a);
    }
    const double height = cloud.points[grid.order()[grid.begin(c)]].z();
    const auto level = height < fine[0] || height > fine[1]
                           ? kAgreement.end()
                           : std::upper_bound(kAgreement.begin(), kAgreement.end(), normal.norm() / count);
    PointCloud& level_points = by_cube[level - kAgreement.begin()];
    for (int i = grid.begin(c); i < grid.end(c); ++i) {
      level_points.points.push_back(cloud.points[grid.order()[i]]);
      level_points.normals.push_back(cloud.normals[grid.order()[i]]);
    }
  }
  PointCloud means;
  for (std::size_t level = 0; level < kCube.size(); ++level)
    for (int time = 0; time < kTimes[level]; ++time) add_means(by_cube[level], kCube[level], means);
  return means;
}

}  // namespace tensegric_fit::reconstruction
