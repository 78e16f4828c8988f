#include "mesh_files/maker_files.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "mesh_files/frame.hpp"

namespace tensegric_fit::mesh_files {
namespace {

constexpr double kMillimetres = 1000;

}  // namespace

std::string obj_text(const geometry::TriangleMesh& mesh, const std::string& name) {
  std::string text = "# tensegric_fit: millimetres, y up, facing +z\no " + name + "\n";
  const auto add = [&text](char kind, const Eigen::Vector3d& p) {
    fmt::format_to(std::back_inserter(text), "{} {:.4f} {:.4f} {:.4f}\n", kind == 'v' ? "v" : "vn", p.x(),
                   p.y(), p.z());
  };
  for (const Eigen::Vector3d& p : mesh.vertices) add('v', kMillimetres * y_up(p));
  for (const Eigen::Vector3d& n : geometry::vertex_normals(mesh.vertices, mesh.triangles)) add('n', y_up(n));
  for (const Eigen::Vector3i& t : mesh.triangles)
    fmt::format_to(std::back_inserter(text), "f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string stl_bytes(const geometry::TriangleMesh& mesh) {
  std::string bytes = "tensegric_fit: millimetres, y up, facing +z";  // not "solid": that would be ASCII
  bytes.resize(80, ' ');
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int c) { return Eigen::Vector3d(kMillimetres * y_up(mesh.vertices[t[c]])); };
    const Eigen::Vector3d normal = geometry::area_vector(corner(0), corner(1), corner(2)).normalized();
    for (const Eigen::Vector3d& v : {normal, corner(0), corner(1), corner(2)})
      for (int axis = 0; axis < 3; ++axis) append(static_cast<float>(v[axis]));
    append(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace tensegric_fit::mesh_files
