// One surface by PCL's screened Poisson reconstruction: points from standard input, triangles to standard
// output (poisson_protocol.hpp). PoissonWorker starts it.
#include <fcntl.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <new>

#include "reconstruction/poisson_protocol.hpp"

namespace {

using tensegric_fit::reconstruction::PoissonAnswer;
using tensegric_fit::reconstruction::PoissonRequest;

constexpr float kSamplesPerNode = 4;  // cells as deep as the points are dense
constexpr int kFullDepth = 4;         // the octree is complete down to here, also where there are no points

/// The stream that was standard output; what PCL prints there goes nowhere.
std::FILE* answer_stream() {
  std::FILE* answer = fdopen(dup(STDOUT_FILENO), "wb");
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDOUT_FILENO);
  return answer;
}

/// The library's own bounds may fail where memory ends: that is this process's affair.
void limit_memory(std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#else
  static_cast<void>(bytes);
#endif
}

bool read_points(std::uint64_t count, pcl::PointCloud<pcl::PointNormal>& cloud) {
  cloud.reserve(count);
  std::array<float, 6> v;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (std::fread(v.data(), sizeof(v), 1, stdin) != 1) return false;
    cloud.emplace_back(v[0], v[1], v[2], v[3], v[4], v[5]);
  }
  return true;
}

bool write(const pcl::PointCloud<pcl::PointNormal>& vertices, const std::vector<pcl::Vertices>& faces,
           std::FILE* answer) {
  const PoissonAnswer size{vertices.size(), faces.size()};
  std::fwrite(&size, sizeof(size), 1, answer);
  for (const pcl::PointNormal& v : vertices) std::fwrite(v.data, sizeof(float), 3, answer);
  for (const pcl::Vertices& face : faces) {
    const std::array<std::int32_t, 3> triangle{static_cast<std::int32_t>(face.vertices[0]),
                                               static_cast<std::int32_t>(face.vertices[1]),
                                               static_cast<std::int32_t>(face.vertices[2])};
    std::fwrite(triangle.data(), sizeof(triangle), 1, answer);
  }
  return std::fflush(answer) == 0 && std::ferror(answer) == 0;
}

bool work() {
  std::FILE* answer = answer_stream();
  PoissonRequest request{};
  if (answer == nullptr || std::fread(&request, sizeof(request), 1, stdin) != 1) return false;
  limit_memory(request.bytes);
  const auto input = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  if (!read_points(request.points, *input)) return false;
  const int depth = static_cast<int>(request.depth);
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setDepth(depth);
  poisson.setMinDepth(kFullDepth);
  poisson.setSamplesPerNode(kSamplesPerNode);
  poisson.setSolverDivide(depth);  // whole, not in blocks: those save memory and cost time
  poisson.setIsoDivide(depth);
  poisson.setThreads(1);
  poisson.setInputCloud(input);
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> faces;
  poisson.reconstruct(vertices, faces);
  return write(vertices, faces, answer);
}

}  // namespace

int main() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // who started it has the limit on its time
  bool done = false;
  try {
    done = work();
  } catch (const std::bad_alloc&) {
    _exit(tensegric_fit::reconstruction::kOutOfMemory);
  }
  _exit(done ? 0 : 1);  // nothing is left to be cleaned up
}
