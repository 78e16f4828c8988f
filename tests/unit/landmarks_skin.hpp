/// Surfaces for the finders of landmarks.
#pragma once

#include <utility>
#include <vector>

#include "landmarks/surface.hpp"

namespace tensegric_fit::landmarks {

/// Nothing of it an arm's.
inline Surface skin(geometry::TriangleMesh mesh) {
  const std::size_t count = mesh.vertices.size();
  return {std::move(mesh), std::vector<double>(count, 0), {}};
}

}  // namespace tensegric_fit::landmarks
