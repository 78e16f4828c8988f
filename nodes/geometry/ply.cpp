#include "geometry/ply.hpp"

#include <pcl/PolygonMesh.h>
#include <pcl/console/print.h>
#include <pcl/io/ply_io.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include "geometry/ply_header.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {

void read_ply(const std::string& path, pcl::PolygonMesh& mesh) {
  const std::uint64_t faces = check_ply_header(path);
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // the refusal carries its messages
  int result = -1;
  try {
    result = pcl::PLYReader().read(path, mesh);
  } catch (const std::bad_alloc&) {
    throw;  // the file may be sound
  } catch (const std::exception&) {
  }
  if (result < 0) throw Refusal(refusal::kBrokenFile, path + ": is truncated or is not a PLY file");
  const auto is_empty = [](const pcl::Vertices& face) { return face.vertices.empty(); };
  if (faces > 0 && std::all_of(mesh.polygons.begin(), mesh.polygons.end(), is_empty))
    throw Refusal(refusal::kBrokenFile,
                  path + ": its faces are empty or in a form that is not read: lists of uchar and int are");
  // PCL takes the size of a camera's picture, as MeshLab writes it, for the cloud's.
  pcl::PCLPointCloud2& cloud = mesh.cloud;
  if (cloud.point_step > 0 &&
      std::size_t{cloud.width} * cloud.height * cloud.point_step != cloud.data.size()) {
    cloud.width = static_cast<std::uint32_t>(cloud.data.size() / cloud.point_step);
    cloud.height = 1;
    cloud.row_step = cloud.width * cloud.point_step;
  }
}

TriangleMesh read_ply_faces(const std::string& path) {
  pcl::PolygonMesh file;
  read_ply(path, file);
  TriangleMesh mesh;
  mesh.vertices = points_of(file.cloud).points;
  for (const pcl::Vertices& polygon : file.polygons) {
    const auto& v = polygon.vertices;
    for (std::size_t k = 2; k < v.size(); ++k)
      mesh.triangles.emplace_back(static_cast<int>(v[0]), static_cast<int>(v[k - 1]), static_cast<int>(v[k]));
  }
  return mesh;
}

TriangleMesh read_ply_mesh(const std::string& path) {
  TriangleMesh mesh = read_ply_faces(path);
  if (mesh.vertices.empty() || mesh.triangles.empty())
    throw Refusal(refusal::kBadMesh, path + ": has no triangles");
  check_mesh(mesh);
  return mesh;
}

std::string ply_bytes(const TriangleMesh& mesh, const std::vector<std::array<std::uint8_t, 3>>& colours,
                      Coordinates coordinates) {
  const bool exact = coordinates == Coordinates::float64;
  const std::string type = exact ? "double" : "float";
  const bool coloured = colours.size() == mesh.vertices.size() && !colours.empty();
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment tensegric_fit, metres\nelement vertex " +
                      std::to_string(mesh.vertices.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) bytes += "property " + type + " " + axis + "\n";
  if (coloured) bytes += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes += "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto append = [&bytes](const auto* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof *values);
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3f p = mesh.vertices[v].cast<float>();
    if (exact)
      append(mesh.vertices[v].data(), 3);
    else
      append(p.data(), 3);
    if (coloured) append(colours[v].data(), 3);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    bytes += '\3';
    append(t.data(), 3);
  }
  return bytes;
}

void write_ply_mesh(const std::string& path, const TriangleMesh& mesh,
                    const std::vector<std::array<std::uint8_t, 3>>& colours, Coordinates coordinates) {
  const std::string unfinished = path + ".part";
  {
    std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
    file << ply_bytes(mesh, colours, coordinates) << std::flush;
    if (!file) {
      std::remove(unfinished.c_str());
      throw std::runtime_error(path + ": cannot be written");
    }
  }
  std::filesystem::rename(unfinished, path);
}

}  // namespace tensegric_fit::geometry
