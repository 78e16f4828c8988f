/// The header of a PLY file, read so strictly that PCL cannot take it for anything else.
#pragma once

#include <string>

namespace tensegric_fit::geometry {

/// PCL's reader ends the process on some headers, reads or writes beyond its points on others, and makes room
/// for as much as a header says; those are refused. So are range grids, whose cells it does not check.
/// \throw Refusal broken_file
void check_ply_header(const std::string& path);

}  // namespace tensegric_fit::geometry
