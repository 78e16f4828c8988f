/// One reader per format: bytes of a file -> mesh, corners as in the file. `path` is for messages only.
#pragma once

#include <cstddef>
#include <string>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// \throw Refusal as read_mesh()
geometry::TriangleMesh obj_mesh(const std::string& bytes, const std::string& path);
geometry::TriangleMesh stl_mesh(const std::string& bytes, const std::string& path);
geometry::TriangleMesh glb_mesh(const std::string& bytes, const std::string& path);
geometry::TriangleMesh gltf_mesh(const std::string& bytes, const std::string& path);

/// \throw Refusal too_many_points: before the mesh has more than read_mesh.hpp plans for
void check_count(std::size_t vertices, std::size_t triangles, const std::string& path);

}  // namespace tensegric_fit::mesh_files
