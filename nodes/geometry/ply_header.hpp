/// The header of a PLY file, read so strictly that PCL cannot take it for anything else.
#pragma once

#include <cstdint>
#include <string>

namespace tensegric_fit::geometry {

/// PCL's reader ends the process on some headers, reads or writes beyond its points on others, and makes room
/// for as much as a header says; those are refused. So are range grids, whose cells it does not check.
/// Returns how many faces it says that there are. \throw Refusal broken_file
std::uint64_t check_ply_header(const std::string& path);

}  // namespace tensegric_fit::geometry
