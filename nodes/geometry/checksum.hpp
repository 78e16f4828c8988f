/// FNV-1a of 64 bits (draft-eastlake-fnv): the same in each process and build, as std::hash need not be.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tensegric_fit::geometry {

inline constexpr std::uint64_t kEmptyChecksum = 14695981039346656037u;

/// The checksum of what `before` is of, followed by these bytes.
inline std::uint64_t checksum(std::uint64_t before, const void* bytes, std::size_t count) {
  const auto* byte = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) before = (before ^ byte[i]) * 1099511628211u;
  return before;
}

}  // namespace tensegric_fit::geometry
