/// Screened Poisson surface reconstruction (Kazhdan and Hoppe 2013), by PCL, in a process of its own: PCL
/// keeps global state, leaks 4 MB per surface, prints to standard output, and has crashed.
#pragma once

#include <cstddef>

#include "geometry/child_process.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::reconstruction {

/// What one surface may take. A body takes 1 s and 0.3 GB, 400,000 points on a ball as large as the octree 20
/// s and 0.7 GB.
struct PoissonLimits {
  double seconds = 120;                      ///< of the clock, for machines that are shared
  std::size_t bytes = std::size_t{4} << 30;  ///< of address space; not where a sanitizer needs more
};

class PoissonWorker {
 public:
  /// Starts the process; loading PCL takes it 0.02 s, so start it before its work is at hand.
  explicit PoissonWorker(const PoissonLimits& limits = {});

  /// A surface around the points, as PCL leaves it: it can have bubbles and spots that are not manifold. Its
  /// cells are as fine as the points are dense, down to `depth`. Once per worker. \pre float32 resolves the
  /// coordinates; unit normals \throw Refusal surface_failed: the process crashed or reached a limit
  geometry::TriangleMesh surface(const geometry::PointCloud& cloud, int depth);

 private:
  PoissonLimits limits_;
  geometry::ChildProcess process_;
};

}  // namespace tensegric_fit::reconstruction
