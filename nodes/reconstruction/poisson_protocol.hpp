/// What PoissonWorker and its process say to each other, as bytes of this machine.
#pragma once

#include <cstdint>

namespace tensegric_fit::reconstruction {

/// Before the points: x, y, z and normal of each as float.
struct PoissonRequest {
  std::uint64_t bytes;  ///< of address space, at most
  std::uint64_t points;
  std::int64_t depth;
};

/// Before the vertices (x, y, z as float) and the triangles (three int32 each).
struct PoissonAnswer {
  std::uint64_t vertices, triangles;
};

inline constexpr int kOutOfMemory = 3;  ///< the process's exit code

}  // namespace tensegric_fit::reconstruction
