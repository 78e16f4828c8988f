/// Scans from files: clouds, the first PointCloud2 of a bag, or meshes, which are taken as samples of a
/// surface.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "mesh_files/reading.hpp"
#include "mesh_files/samples.hpp"

namespace tensegric_fit::scan_files {

/// Whether a file of that name can be a scan, by its ending, in either case: .ply, .pcd, .xyz, .bag, .obj,
/// .stl, .glb, .gltf.
bool is_scan_name(const std::string& path);
/// Whether it comes with a mesh and is not read: materials, textures.
bool is_companion_name(const std::string& path);

/// A file's points, in its own unit and axes; the fields are as the file has them, of a mesh x y z and, where
/// its triangles run alike, normals. geometry::points_of checks them.
struct ScanFile {
  pcl::PCLPointCloud2 cloud;
  mesh_files::Kind kind;
  bool is_message = false;  ///< from a bag: metres, z up
};

/// By the file's ending; a mesh becomes so many points. \throw Refusal broken_file, bad_mesh,
/// too_many_points, bad_option (another ending)
ScanFile read_scan_file(const std::string& path, int samples = mesh_files::kSamples);

/// How files of one person in one frame are read: as asked for, or inferred from all their points (metres and
/// z up where they have none). \throw Refusal as mesh_files::infer_reading
mesh_files::Reading reading_of(const std::vector<ScanFile>& files, const mesh_files::Asked& asked);

/// The cloud in metres, z up: positions and normals; other fields stay.
void apply(const mesh_files::Reading& reading, pcl::PCLPointCloud2& cloud);

/// A mesh of .ply, .obj, .stl, .glb or .gltf as it is, in metres, z up. \param any_shape it need not be a
/// body: what is not asked for is metres, z up \throw Refusal broken_file, bad_mesh, ...
geometry::TriangleMesh read_body_mesh(const std::string& path, const mesh_files::Asked& asked, bool any_shape,
                                      mesh_files::Reading& reading);

}  // namespace tensegric_fit::scan_files
