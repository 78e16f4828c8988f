#include "reconstruction/poisson.hpp"

#include <fcntl.h>
#include <pcl/point_types.h>
#include <pcl/surface/poisson.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace tensegric_fit::reconstruction {
namespace {

constexpr float kSamplesPerNode = 4;  // cells as deep as the points are dense
constexpr int kFullDepth = 4;         // the octree is complete down to here, also where there are no points

/// PCL prints to standard output, which belongs to the program's user: it goes nowhere while one lives.
class QuietOutput {
 public:
  QuietOutput() {
    std::fflush(stdout);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    output_ = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    if (output_ >= 0) dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
  ~QuietOutput() {
    if (output_ < 0) return;
    std::fflush(stdout);
    dup2(output_, STDOUT_FILENO);
    close(output_);
  }
  QuietOutput(const QuietOutput&) = delete;
  QuietOutput& operator=(const QuietOutput&) = delete;

 private:
  int output_ = -1;
};

}  // namespace

geometry::TriangleMesh poisson_surface(const geometry::PointCloud& cloud, int depth) {
  const auto input = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  input->reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f p = cloud.points[i].cast<float>(), n = cloud.normals[i].cast<float>();
    input->emplace_back(p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> faces;
  {
    static std::mutex one_at_a_time;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    const QuietOutput quiet;
    pcl::Poisson<pcl::PointNormal> poisson;
    poisson.setDepth(depth);
    poisson.setMinDepth(kFullDepth);
    poisson.setSamplesPerNode(kSamplesPerNode);
    poisson.setSolverDivide(depth);  // whole, not in blocks: those save memory and cost time
    poisson.setIsoDivide(depth);
    poisson.setThreads(1);
    poisson.setInputCloud(input);
    poisson.reconstruct(vertices, faces);
  }
  geometry::TriangleMesh mesh;
  mesh.vertices.reserve(vertices.size());
  for (const pcl::PointNormal& v : vertices) mesh.vertices.emplace_back(v.x, v.y, v.z);
  mesh.triangles.reserve(faces.size());
  for (const pcl::Vertices& face : faces)
    mesh.triangles.emplace_back(static_cast<int>(face.vertices[0]), static_cast<int>(face.vertices[1]),
                                static_cast<int>(face.vertices[2]));
  return mesh;
}

}  // namespace tensegric_fit::reconstruction
