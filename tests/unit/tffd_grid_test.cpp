#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "../peak_memory.hpp"
#include "tffd/triangle_grid.hpp"
#include "tffd_shapes.hpp"

namespace tensegric_fit::tffd {
namespace {

// Not one triangle in reach may be missed, whatever the sizes of the triangles.
TEST(TriangleGrid, FindsEveryTriangleInReach) {
  std::vector<Frame> alike = frames_of(patch(), Axis::inner_to_outer);
  std::vector<Frame> unlike = alike;
  geometry::ControlMesh large = ball();
  for (auto* nodes : {&large.outer, &large.inner})
    for (Eigen::Vector3d& p : *nodes) p = 10 * p + Eigen::Vector3d(0.5, 0, 0);
  for (const Frame& frame : frames_of(large, Axis::inner_to_outer)) unlike.push_back(frame);

  std::mt19937 random(3);
  for (const auto& frames : {alike, unlike})
    for (const double reach : {1.0, 2.0, 20.0}) {
      const TriangleGrid grid(frames, reach);
      std::size_t found = 0, in_reach = 0, out_of_reach = 0;
      for (int trial = 0; trial < 2000; ++trial) {
        const double size = trial % 2 ? 0.2 : 3;
        std::uniform_real_distribution<double> coordinate(-size, size);
        const Eigen::Vector3d q(coordinate(random), coordinate(random), coordinate(random));
        const TriangleGrid::Range near = grid.near(q);
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        found += static_cast<std::size_t>(near.end() - near.begin());
        for (int t = 0; t < static_cast<int>(frames.size()); ++t) {
          if (frames[t].farther_than(reach * frames[t].radius, q)) {
            ++out_of_reach;
            continue;
          }
          ++in_reach;
          EXPECT_TRUE(std::binary_search(near.begin(), near.end(), t)) << "seed 3, trial " << trial;
        }
      }
      EXPECT_GT(in_reach, 100U);
      EXPECT_LT(found - in_reach,
                0.5 * static_cast<double>(out_of_reach));  // and it does leave triangles out
    }
}

// A cell is half as wide as a triangle's reach: of equal triangles none is found from farther than that and
// a cell's diagonal, and there are no more cells than that makes.
TEST(TriangleGrid, CellsAreHalfAsWideAsTheReach) {
  std::vector<Frame> frames(400, frames_of(patch(), Axis::inner_to_outer).front());
  for (std::size_t i = 0; i < frames.size(); ++i)
    frames[i].centroid = Eigen::Vector3d(0.02 * (i % 20), 0.02 * (i / 20), 0);
  constexpr double kReach = 1.3;
  const TriangleGrid grid(frames, kReach);
  const double reach = (kReach + 1.5) * frames.front().radius, far = reach * (1 + std::sqrt(3) / 2);
  std::size_t found = 0;
  for (const Frame& frame : frames)
    for (const int t : grid.near(frame.centroid)) {
      EXPECT_LT((frames[t].centroid - frame.centroid).norm(), 1.0001 * far);
      ++found;
    }
  EXPECT_GT(found, frames.size());
  EXPECT_LT(far, 0.1);  // of 0.4 m
  std::set<const int*> cells;
  for (double x = 0; x < 0.38; x += 0.0005) cells.insert(grid.near({x, 0.1, 0}).begin());
  EXPECT_LE(cells.size(), 0.38 / (reach / 2) + 2);
}

TEST(TriangleGrid, LargeTrianglesAmongSmallOnesDoNotFillTheMemory) {
  constexpr std::size_t kLarge = 1000;
  constexpr double kReach = 1.3;
  std::vector<Frame> frames(16 * kLarge, frames_of(patch(), Axis::inner_to_outer).front());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].centroid = Eigen::Vector3d(0.02 * (i % 20), 0.02 * (i / 20 % 20), 0.01 * (i / 400));
    frames[i].radius = i < kLarge ? 1 : 0.001;
  }
  const gauge::Growth growth;
  const TriangleGrid grid(frames, kReach);
  EXPECT_LT(growth.mebibytes(), 150);  // each large one in all cells: 340
  for (const Eigen::Vector3d& q : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.2, 0.2, 0.2)}) {
    const TriangleGrid::Range near = grid.near(q);
    for (int t = 0; t < static_cast<int>(frames.size()); ++t) {
      if (frames[t].farther_than(kReach * frames[t].radius, q)) continue;
      EXPECT_TRUE(std::binary_search(near.begin(), near.end(), t)) << t;
    }
  }
}

}  // namespace
}  // namespace tensegric_fit::tffd
