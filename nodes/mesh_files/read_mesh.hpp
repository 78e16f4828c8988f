/// Reads meshes of scanners: OBJ, STL, GLB, glTF. PLY and clouds are read by PCL (geometry/ply.hpp,
/// scan_files).
#pragma once

#include <cstddef>
#include <string>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// What is planned for; more is refused before memory is taken, more vertices of an STL once they are joined.
inline constexpr std::size_t kMostBytes = 512UL << 20, kMostVertices = 10'000'000,
                             kMostTriangles = 20'000'000;

/// The ending of a file's name in small letters, with its dot.
std::string ending_of(const std::string& path);

/// .obj, .stl, .glb or .gltf, in either case.
bool is_mesh_name(const std::string& path);

/// By the file's ending, in the file's own unit and axes: all meshes of the scene, where its nodes put them;
/// polygons fanned; vertices in one place are one; triangles without three corners and vertices without a
/// triangle are left out. Nothing else is read: no colours, materials, textures; no other file is opened.
/// \throw Refusal broken_file (also a glTF that a skeleton or morph targets shape), bad_mesh (no faces,
/// indices out of range), non_finite, too_many_points
geometry::TriangleMesh read_mesh(const std::string& path);

/// Vertices in one place are one; triangles without three corners and vertices without a triangle are left
/// out. \pre each corner is a vertex
geometry::TriangleMesh tidy(geometry::TriangleMesh mesh);

/// The same of a mesh as it is in the file `path`. `most_vertices`: once those in one place are one.
/// \throw Refusal non_finite, bad_mesh, too_many_points
geometry::TriangleMesh checked_and_tidy(geometry::TriangleMesh mesh, const std::string& path,
                                        std::size_t most_vertices = kMostVertices);

/// Text with x y z at the start of each line, parted by blanks, commas or semicolons; further columns are
/// left out, and a first line that is a heading or a count. \throw Refusal broken_file, too_many_points
std::vector<Eigen::Vector3d> read_xyz(const std::string& path);

}  // namespace tensegric_fit::mesh_files
