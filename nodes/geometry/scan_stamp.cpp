#include "geometry/scan_stamp.hpp"

#include <charconv>

namespace tensegric_fit::geometry {

std::optional<std::uint64_t> stamp_in(const std::string& scan_id) {
  std::uint32_t seconds = 0, nanoseconds = 0;
  const char* const end = scan_id.data() + scan_id.size();
  const auto whole = std::from_chars(scan_id.data(), end, seconds);
  if (whole.ec != std::errc() || whole.ptr == end || *whole.ptr != '.') return std::nullopt;
  if (std::from_chars(whole.ptr + 1, end, nanoseconds).ec != std::errc()) return std::nullopt;
  return 1000000000ull * seconds + nanoseconds;
}

}  // namespace tensegric_fit::geometry
