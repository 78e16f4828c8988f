/// OBJ and STL as makers' programs take them: millimetres, y up, facing +z, triangles counter-clockwise from
/// outside.
#pragma once

#include <string>

#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::mesh_files {

/// \param mesh body frame, metres
std::string obj_text(const geometry::TriangleMesh& mesh, const std::string& name);

/// Binary. \param mesh body frame, metres
std::string stl_bytes(const geometry::TriangleMesh& mesh);

}  // namespace tensegric_fit::mesh_files
