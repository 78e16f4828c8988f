/// Writes GLB (binary glTF 2.0): meshes with vertex colours, values per vertex and morph targets in one file.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// Values per vertex that programs may read, such as the distortion under the finger.
struct GlbScalar {
  std::string name;  ///< begins with '_', capital letters, as glTF asks: _DISTORTION
  std::vector<float> values;
};

/// Where the vertices of a mesh are at weight 1.
struct GlbMorph {
  std::string name;
  std::vector<Eigen::Vector3d> vertices;  ///< as many as the mesh has
};

/// One mesh, a node of the scene. Body frame (x forward, y to her left, z up), metres.
struct GlbMesh {
  std::string name;
  geometry::TriangleMesh shape;
  std::vector<std::array<std::uint8_t, 3>> colours = {};  ///< sRGB per vertex, or empty
  std::vector<GlbScalar> scalars = {};
  std::vector<GlbMorph> morphs = {};
  std::array<std::uint8_t, 3> colour = {255, 255,
                                        255};  ///< sRGB of its material; vertex colours are times it
  nlohmann::json extras = nullptr;             ///< of its node
};

/// The file: y up, facing +z (frame.hpp), metres, smooth normals, also of each morph target. Same arguments,
/// same bytes. `extras`: of the asset. \throw Refusal bad_mesh, non_finite: a mesh that check_mesh() refuses
/// or that has no triangles, arrays of another length than its vertices, a file of 4 GB or more
std::string glb_bytes(const std::vector<GlbMesh>& meshes, const nlohmann::json& extras = nullptr);

/// A tube of `sides` sides (3 or more) and radius `radius`, metres, along a polyline of two points or more,
/// closed by caps. Its number of vertices depends on the numbers of points and sides only: a line before and
/// after with as many points are morph targets of each other.
geometry::TriangleMesh tube(const std::vector<Eigen::Vector3d>& line, double radius, int sides = 8);

}  // namespace tensegric_fit::mesh_files
