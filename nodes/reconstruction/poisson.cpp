#include "reconstruction/poisson.hpp"

#include <array>
#include <cstring>
#include <string>

#include "geometry/spawned_process.hpp"
#include "geometry/status.hpp"
#include "reconstruction/poisson_protocol.hpp"

namespace tensegric_fit::reconstruction {
namespace {

using geometry::ChildFailure;
using geometry::Refusal;
namespace refusal = geometry::refusal;

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Values in the order in which they were written. \pre `bytes` has them
template <typename T>
T take(const std::string& bytes, std::size_t& at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  at += sizeof(value);
  return value;
}

std::string request(const geometry::PointCloud& cloud, int depth, std::size_t limit) {
  std::string bytes;
  bytes.reserve(sizeof(PoissonRequest) + cloud.points.size() * 6 * sizeof(float));
  append(bytes, PoissonRequest{limit, cloud.points.size(), depth});
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    for (const Eigen::Vector3d& v : {cloud.points[i], cloud.normals[i]})
      for (int axis = 0; axis < 3; ++axis) append(bytes, static_cast<float>(v[axis]));
  return bytes;
}

geometry::TriangleMesh mesh_of(const std::string& bytes) {
  std::size_t at = 0;
  PoissonAnswer size{};
  if (bytes.size() >= sizeof(size)) size = take<PoissonAnswer>(bytes, at);
  const std::size_t item = 3 * sizeof(float);
  if (bytes.size() != sizeof(size) + item * (size.vertices + size.triangles))
    throw ChildFailure("gave half an answer");
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(size.vertices);
  for (std::size_t i = 0; i < size.vertices; ++i) {
    const auto v = take<std::array<float, 3>>(bytes, at);
    mesh.vertices.emplace_back(v[0], v[1], v[2]);
  }
  mesh.triangles.reserve(size.triangles);
  for (std::size_t i = 0; i < size.triangles; ++i) {
    const auto t = take<std::array<std::int32_t, 3>>(bytes, at);
    mesh.triangles.emplace_back(t[0], t[1], t[2]);
  }
  return mesh;
}

Refusal failed(const ChildFailure& failure) {
  const std::string why = failure.exit_code == kOutOfMemory ? "ran out of memory" : failure.what();
  return Refusal(refusal::kSurfaceFailed, "the process that makes the surface " + why);
}

}  // namespace

PoissonWorker::PoissonWorker(const PoissonLimits& limits) try
    : limits_(limits), process_(geometry::sibling_program("poisson_worker")) {
} catch (const ChildFailure& failure) {
  throw failed(failure);
}

geometry::TriangleMesh PoissonWorker::surface(const geometry::PointCloud& cloud, int depth) {
  try {
    return mesh_of(process_.answer(request(cloud, depth, limits_.bytes), limits_.seconds));
  } catch (const ChildFailure& failure) {
    throw failed(failure);
  }
}

}  // namespace tensegric_fit::reconstruction
