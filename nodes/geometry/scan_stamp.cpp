#include "geometry/scan_stamp.hpp"

#include <fmt/format.h>

#include <charconv>
#include <ctime>

namespace tensegric_fit::geometry {

std::optional<std::uint64_t> stamp_in(const std::string& scan_id) {
  std::uint32_t seconds = 0, nanoseconds = 0;
  const char* const end = scan_id.data() + scan_id.size();
  const auto whole = std::from_chars(scan_id.data(), end, seconds);
  if (whole.ec != std::errc() || whole.ptr == end || *whole.ptr != '.') return std::nullopt;
  if (std::from_chars(whole.ptr + 1, end, nanoseconds).ec != std::errc()) return std::nullopt;
  return 1000000000ull * seconds + nanoseconds;
}

std::string day_of(double seconds) {
  constexpr double kClocksAreSet = 946684800, kLatest = 253402300800;  // s, the years 2000 and 10000
  if (!(seconds >= kClocksAreSet && seconds < kLatest)) return "";
  const auto time = static_cast<std::time_t>(seconds);
  std::tm day{};
  localtime_r(&time, &day);
  return fmt::format("{:04}-{:02}-{:02}", day.tm_year + 1900, day.tm_mon + 1, day.tm_mday);
}

}  // namespace tensegric_fit::geometry
