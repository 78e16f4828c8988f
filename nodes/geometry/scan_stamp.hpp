/// When a scan was seen, as its id says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tensegric_fit::geometry {

/// ns, of an id "<sec>.<nsec>", whatever follows; nothing where it is of another form.
std::optional<std::uint64_t> stamp_in(const std::string& scan_id);

}  // namespace tensegric_fit::geometry
