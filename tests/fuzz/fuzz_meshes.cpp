// Scan and mesh files. The first byte chooses the format and what is asked for, the rest is the file.
#include <array>

#include "fuzz_target.hpp"
#include "geometry/point_cloud.hpp"
#include "scan_files/scan_file.hpp"

namespace {

using namespace tensegric_fit;

void read_scan(const std::string& path, const mesh_files::Asked& asked) {
  fuzz::require(scan_files::is_scan_name(path) && !scan_files::is_companion_name(path));
  scan_files::ScanFile file = scan_files::read_scan_file(path, 200);
  const geometry::PointCloud cloud = geometry::points_of(file.cloud);
  fuzz::require(cloud.normals.empty() || cloud.normals.size() == cloud.points.size());
  scan_files::apply(scan_files::reading_of({file}, asked), file.cloud);
  fuzz::require(geometry::points_of(file.cloud).points.size() == cloud.points.size());
}

void read_mesh(const std::string& path, const mesh_files::Asked& asked, bool any_shape) {
  mesh_files::Reading reading;
  const geometry::TriangleMesh mesh = scan_files::read_body_mesh(path, asked, any_shape, reading);
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (const int v : triangle) fuzz::require(v >= 0 && v < static_cast<int>(mesh.vertices.size()));
  for (const Eigen::Vector3d& v : mesh.vertices) fuzz::require(v.allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kEndings{".obj", ".stl", ".glb", ".gltf", ".xyz", ".ply", ".pcd"};
  static const std::array<mesh_files::Asked, 4> kAsked{{{}, {"mm", ""}, {"inch", "-y"}, {"", "x"}}};
  if (size < 1) return 0;
  const fuzz::InputFile file(data + 1, size - 1, kEndings[data[0] % kEndings.size()]);
  const std::size_t way = data[0] / kEndings.size();
  const mesh_files::Asked& asked = kAsked[way % kAsked.size()];
  fuzz::refused_or_done([&] { read_scan(file.path(), asked); });
  fuzz::refused_or_done([&] { read_mesh(file.path(), asked, way / kAsked.size() % 2 == 0); });
  return 0;
}
