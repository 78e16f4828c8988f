#include "reconstruction/surface_points.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "geometry/parallel_for.hpp"
#include "geometry/percentile.hpp"
#include "geometry/point_tree.hpp"
#include "reconstruction/voxel_grid.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr int kNeighbours = 16;
constexpr double kSurroundings = 0.03;  // m; 27 cubes of it show how far neighbours usually are
constexpr double kFar = 1.5;            // usual distances
constexpr double kFillsSpace = 0.2;  // least variance over the sum of all three: 1/3 in a cloud, 0 in a plane
constexpr double kMostOfAGoodScan = 0.1;  // share of its points that look stray: 0.02 on known ones
constexpr std::size_t kSampleStep = 16;   // one point in so many shows whether the scan is good

/// Which of every `step`-th point look stray.
std::vector<char> look_stray(const Points& points, const geometry::PointTree& tree, std::size_t step) {
  const std::size_t count = (points.size() + step - 1) / step;
  Points sample(count);
  std::vector<double> reach(count);
  std::vector<char> stray(count);
  geometry::parallel_for(count, [&](std::size_t begin, std::size_t end, int) {
    std::vector<int> near;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    for (std::size_t s = begin; s < end; ++s) {
      sample[s] = points[s * step];
      tree.nearest(sample[s], kNeighbours, near);
      reach[s] = (points[near.back()] - sample[s]).norm();
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
      for (int j : near) {
        const Eigen::Vector3d d = points[j] - sample[s];
        sum += d;
        products += d * d.transpose();
      }
      axes.computeDirect(products - sum * sum.transpose() / static_cast<double>(near.size()),
                         Eigen::EigenvaluesOnly);
      stray[s] = axes.eigenvalues()[0] > kFillsSpace * axes.eigenvalues().sum();
    }
  });
  const VoxelGrid grid(sample, kSurroundings);
  std::vector<int> around;
  std::vector<double> reaches;
  for (int c = 0; c < grid.cell_count(); ++c) {
    grid.around(c, around);
    reaches.clear();
    for (int a : around)
      for (int i = grid.begin(a); i < grid.end(a); ++i) reaches.push_back(reach[grid.order()[i]]);
    const double usual = geometry::percentile(reaches, 0.5);
    for (int i = grid.begin(c); i < grid.end(c); ++i)
      if (reach[grid.order()[i]] > kFar * usual) stray[grid.order()[i]] = 1;
  }
  return stray;
}

}  // namespace

std::vector<int> surface_points(const Points& points) {
  std::vector<int> kept(points.size());
  std::iota(kept.begin(), kept.end(), 0);
  if (points.empty()) return kept;
  const geometry::PointTree tree(points);
  const std::vector<char> sample = look_stray(points, tree, kSampleStep);
  const auto stray_of_sample = std::count(sample.begin(), sample.end(), 1);
  if (static_cast<double>(stray_of_sample) < kMostOfAGoodScan * static_cast<double>(sample.size()))
    return kept;
  const std::vector<char> stray = look_stray(points, tree, 1);
  kept.erase(std::remove_if(kept.begin(), kept.end(), [&](int i) { return stray[i]; }), kept.end());
  return kept;
}

}  // namespace tensegric_fit::reconstruction
