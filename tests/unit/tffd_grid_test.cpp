#include <gtest/gtest.h>

#include <algorithm>
#include <random>

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

}  // namespace
}  // namespace tensegric_fit::tffd
