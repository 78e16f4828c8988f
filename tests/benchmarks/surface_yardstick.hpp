/// What reconstructions are given and judged by, ours and others'.
#pragma once

#include <benchmark/benchmark.h>

#include "customer.hpp"
#include "surface_distance.hpp"

namespace tensegric_fit::benchmarks {

/// The scan's points on the body, with outward normals: the others get them for nothing.
const geometry::PointCloud& oriented_points();

/// Counters: triangles, closed (1 or 0), and the distance to the true skin, truth_median_mm, truth_p95_mm
/// and truth_p99_mm. Vertices flagged in `filled` are left out; it may be empty.
void report_surface(benchmark::State& state, const geometry::TriangleMesh& mesh,
                    const std::vector<char>& filled);

/// The same; a vertex counts as filled where our own reconstruction would say so.
void report_yardstick(benchmark::State& state, const geometry::TriangleMesh& mesh);

}  // namespace tensegric_fit::benchmarks
