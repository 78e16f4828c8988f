/// PLY files of meshes: the only mesh format that the product reads and writes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace pcl {
struct PolygonMesh;
}

namespace tensegric_fit::geometry {

/// Reads a PLY of points or of a mesh unchanged: ASCII, or binary of either byte order.
/// \throw Refusal broken_file: does not exist, truncated, not PLY
void read_ply(const std::string& path, pcl::PolygonMesh& mesh);

/// Reads a mesh as it is in the file, unchecked; faces with more than three corners are fanned.
/// \throw Refusal broken_file, wrong_fields
TriangleMesh read_ply_faces(const std::string& path);

/// The same, checked. \throw Refusal broken_file, wrong_fields, bad_mesh (no triangles), as check_mesh()
TriangleMesh read_ply_mesh(const std::string& path);

/// Bodies are written as float32; control meshes as float64, since numerical accuracy is checked on them.
enum class Coordinates { float32, float64 };

/// A file's bytes: binary little-endian; `colours` is empty or has one RGB triple per vertex.
std::string ply_bytes(const TriangleMesh& mesh, const std::vector<std::array<std::uint8_t, 3>>& colours = {},
                      Coordinates coordinates = Coordinates::float32);

/// Writes ply_bytes() to a file atomically. \throw std::runtime_error where it cannot be written
void write_ply_mesh(const std::string& path, const TriangleMesh& mesh,
                    const std::vector<std::array<std::uint8_t, 3>>& colours = {},
                    Coordinates coordinates = Coordinates::float32);

}  // namespace tensegric_fit::geometry
