#include "scan_files/scan_file.hpp"

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "geometry/ply.hpp"
#include "geometry/point_cloud.hpp"
#include "geometry/point_fields.hpp"
#include "geometry/points.hpp"
#include "geometry/status.hpp"
#include "mesh_files/pieces.hpp"
#include "mesh_files/read_mesh.hpp"
#include "scan_files/pcd_file.hpp"
#include "scan_files/scan_bag.hpp"

namespace tensegric_fit::scan_files {
namespace {

using geometry::TriangleMesh;

pcl::PCLPointCloud2 message_of(const geometry::PointCloud& cloud) {
  pcl::PCLPointCloud2 message;
  if (cloud.normals.empty()) {
    pcl::PointCloud<pcl::PointXYZ> points;
    for (const Eigen::Vector3d& p : cloud.points)
      points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
    pcl::toPCLPointCloud2(points, message);
    return message;
  }
  pcl::PointCloud<pcl::PointNormal> points(static_cast<std::uint32_t>(cloud.points.size()), 1);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    points[i].getVector3fMap() = cloud.points[i].cast<float>();
    points[i].getNormalVector3fMap() = cloud.normals[i].cast<float>();
  }
  pcl::toPCLPointCloud2(points, message);
  return message;
}

// A mesh by its faces, where they hold most of the vertices; a cloud with a few faces stays a cloud.
void take_faces(const std::string& path, const pcl::PolygonMesh& file, int samples, ScanFile& scan) {
  if (file.polygons.empty()) return;
  TriangleMesh mesh{geometry::points_of(file.cloud).points, {}};
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const pcl::Vertices& polygon : file.polygons) {
    const auto& v = polygon.vertices;
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (static_cast<std::size_t>(v[k]) >= mesh.vertices.size())
        throw geometry::Refusal(geometry::refusal::kBadMesh,
                                path + ": has a face with a vertex that is not there");
      used[v[k]] = 1;
      if (k >= 2)
        mesh.triangles.emplace_back(static_cast<int>(v[0]), static_cast<int>(v[k - 1]),
                                    static_cast<int>(v[k]));
    }
  }
  if (2 * static_cast<std::size_t>(std::count(used.begin(), used.end(), 1)) < used.size()) return;
  scan.cloud = message_of(mesh_files::surface_samples(mesh_files::tidy(std::move(mesh)), samples));
  scan.kind.surface = true;
}

// A body from PLY as from other formats: faces that share no corners are joined, those without three corners
// and corners of no face left out. Other shapes stay as they are.
TriangleMesh ply_mesh(const std::string& path, bool any_shape) {
  return any_shape ? geometry::read_ply_mesh(path)
                   : mesh_files::checked_and_tidy(geometry::read_ply_faces(path), path);
}

// The up of the format's own definition, where it has one.
mesh_files::Kind kind_of(const std::string& ending) {
  return {true, ending == ".glb" || ending == ".gltf" ? "y" : ending == ".ply" ? "z" : ""};
}

}  // namespace

bool is_scan_name(const std::string& path) {
  const std::string ending = mesh_files::ending_of(path);
  return ending == ".ply" || ending == ".pcd" || ending == ".xyz" || ending == ".bag" ||
         mesh_files::is_mesh_name(path);
}

bool is_companion_name(const std::string& path) {
  const std::string ending = mesh_files::ending_of(path);
  return ending == ".mtl" || ending == ".png" || ending == ".jpg" || ending == ".jpeg";
}

ScanFile read_scan_file(const std::string& path, int samples) {
  const std::string ending = mesh_files::ending_of(path);
  ScanFile scan;
  if (ending == ".ply") {
    pcl::PolygonMesh file;
    geometry::read_ply(path, file);
    take_faces(path, file, samples, scan);
    if (!scan.kind.surface) scan.cloud = std::move(file.cloud);
  } else if (ending == ".pcd") {
    scan.cloud = read_pcd(path);
  } else if (ending == ".xyz") {
    scan.cloud = message_of({mesh_files::read_xyz(path), {}, {}});
  } else if (ending == ".bag") {
    scan.cloud = read_bag_scan(path);
    scan.is_message = true;
  } else if (mesh_files::is_mesh_name(path)) {
    scan.cloud = message_of(mesh_files::surface_samples(mesh_files::read_mesh(path), samples));
    scan.kind = kind_of(ending);
  } else {
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            path + ": a scan file ends in .ply, .pcd, .xyz, .bag, .obj, .stl, .glb or .gltf");
  }
  return scan;
}

mesh_files::Reading reading_of(const std::vector<ScanFile>& files, const mesh_files::Asked& asked) {
  mesh_files::check_asked(asked);
  mesh_files::Kind kind{true, "", asked.unit.empty()};
  mesh_files::Asked wanted = asked;
  std::vector<Eigen::Vector3d> points;
  for (const ScanFile& file : files) {
    if (file.is_message && wanted.unit.empty()) wanted.unit = "m";
    if (file.is_message && wanted.up.empty()) wanted.up = "z";
    const geometry::PointCloud cloud = geometry::points_of(file.cloud);
    for (const Eigen::Vector3d& p : cloud.points)
      if (p.allFinite()) points.push_back(p);
    kind.surface = kind.surface && file.kind.surface;
    if (!file.kind.usual_up.empty()) kind.usual_up = file.kind.usual_up;
  }
  if (points.empty()) points.emplace_back(0, 0, 0);  // refused by the reconstruction, by name
  return mesh_files::infer_reading(points, kind, wanted);
}

void apply(const mesh_files::Reading& reading, pcl::PCLPointCloud2& cloud) {
  if (reading.is_identity()) return;
  const geometry::PointCloud read = geometry::points_of(cloud);
  const bool swapped = cloud.is_bigendian != pcl::PCLPointCloud2().is_bigendian;
  const geometry::PointFields fields = geometry::fields_of(cloud);
  const auto write = [&cloud, swapped](const std::array<const pcl::PCLPointField*, 3>& axes, std::size_t i,
                                       const Eigen::Vector3d& value) {
    for (int axis = 0; axis < 3; ++axis) {
      std::uint8_t* at = cloud.data.data() + i / cloud.width * cloud.row_step +
                         i % cloud.width * cloud.point_step + axes[axis]->offset;
      const auto single = static_cast<float>(value[axis]);
      const bool is_double = axes[axis]->datatype == pcl::PCLPointField::FLOAT64;
      const std::size_t size = is_double ? sizeof(double) : sizeof single;
      std::memcpy(at, is_double ? static_cast<const void*>(&value[axis]) : &single, size);
      if (swapped) std::reverse(at, at + size);
    }
  };
  for (std::size_t i = 0; i < read.points.size(); ++i) {
    write(fields.position, i, reading(read.points[i]));
    if (fields.normal) write(*fields.normal, i, reading.turn() * read.normals[i]);
  }
}

TriangleMesh read_body_mesh(const std::string& path, const mesh_files::Asked& asked, bool any_shape,
                            mesh_files::Reading& reading) {
  mesh_files::check_asked(asked);
  const std::string ending = mesh_files::ending_of(path);
  const bool is_ply = !mesh_files::is_mesh_name(path);
  TriangleMesh mesh = is_ply ? ply_mesh(path, any_shape) : mesh_files::read_mesh(path);
  mesh_files::Asked wanted = asked;
  if (any_shape && wanted.unit.empty()) wanted.unit = "m";
  if (any_shape && wanted.up.empty()) wanted.up = "z";
  mesh_files::Kind kind = kind_of(is_ply ? ".ply" : ending);
  kind.any_size = any_shape;
  constexpr int kEnough = 20'000;
  reading = mesh_files::infer_reading(mesh_files::surface_samples(mesh, kEnough).points, kind, wanted);
  if (!reading.is_identity())
    for (Eigen::Vector3d& p : mesh.vertices) {
      p = reading(p);
      if (!p.allFinite())
        throw geometry::Refusal(geometry::refusal::kNonFinite,
                                path + ": has a coordinate that is not finite in metres");
    }
  if (!any_shape) mesh = mesh_files::turned_alike(std::move(mesh));
  // Inside out as a whole: a body's volume is no negative one. The apex lies in the floor, which may be there
  // in a single layer, and open at the soles.
  Eigen::Vector3d apex = geometry::mean_of(mesh.vertices);
  for (const Eigen::Vector3d& p : mesh.vertices) apex.z() = std::min(apex.z(), p.z());
  if (!any_shape && geometry::cone_volume(mesh.vertices, mesh.triangles, apex) < 0)
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace tensegric_fit::scan_files
