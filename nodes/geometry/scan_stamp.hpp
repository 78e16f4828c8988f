/// When a scan was seen, as its id says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tensegric_fit::geometry {

/// ns, of an id "<sec>.<nsec>", whatever follows; nothing where it is of another form.
std::optional<std::uint64_t> stamp_in(const std::string& scan_id);

/// The day, "2026-11-30", of a time in s since 1970, by the machine's time zone; empty before 2000, where
/// clocks are that start at zero, and after 9999.
std::string day_of(double seconds);

}  // namespace tensegric_fit::geometry
