/// Bytes whose lengths are not believed before they are looked at.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace tensegric_fit::files {

using Bytes = std::string_view;

/// What is wrong with the bytes: "is shorter ...".
struct Fault {
  std::string what;
};

inline void check(bool holds, const char* what) {
  if (!holds) throw Fault{what};
}

/// Takes from the front of what is left. All \throw Fault
inline Bytes take(Bytes& rest, std::uint64_t size) {
  check(size <= rest.size(), "is shorter than its lengths say");
  const Bytes taken = rest.substr(0, size);
  rest.remove_prefix(size);
  return taken;
}

template <typename Number>
Number number_in(Bytes bytes) {
  check(bytes.size() == sizeof(Number), "has a number of another size");
  Number number;
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

inline std::uint32_t take_length(Bytes& rest) {
  return number_in<std::uint32_t>(take(rest, 4));
}

/// Bytes after their length.
inline Bytes take_block(Bytes& rest) {
  const std::uint32_t size = take_length(rest);
  return take(rest, size);
}

}  // namespace tensegric_fit::files
