// Scan and mesh files. The first byte chooses the format, the rest is the file.
#include "fuzz_target.hpp"
#include "geometry/point_cloud.hpp"
#include "scan_files/scan_file.hpp"

namespace {

using namespace tensegric_fit;

void read_both_ways(const std::string& path) {
  fuzz::refused_or_done([&] {
    const scan_files::ScanFile file = scan_files::read_scan_file(path);
    const geometry::PointCloud cloud = geometry::points_of(file.cloud);
    fuzz::require(cloud.normals.empty() || cloud.normals.size() == cloud.points.size());
  });
  fuzz::refused_or_done([&] {
    mesh_files::Reading reading;
    const geometry::TriangleMesh mesh = scan_files::read_body_mesh(path, {}, true, reading);
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      for (const int v : triangle) fuzz::require(v >= 0 && v < static_cast<int>(mesh.vertices.size()));
    for (const Eigen::Vector3d& v : mesh.vertices) fuzz::require(v.allFinite());
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kEndings[] = {".obj", ".stl", ".glb", ".gltf", ".xyz", ".ply", ".pcd"};
  if (size < 1) return 0;
  const fuzz::InputFile file(data + 1, size - 1, kEndings[data[0] % 7]);
  read_both_ways(file.path());
  return 0;
}
