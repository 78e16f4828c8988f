/// Where a text file begins, and its numbers.
#pragma once

#include <charconv>
#include <string_view>

namespace tensegric_fit::mesh_files {

/// Without the mark of UTF-8 that some programs begin a file with: it would be taken for the first word's.
inline std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(text.compare(0, kMark.size(), kMark) == 0 ? kMark.size() : 0);
}

/// As std::from_chars, and with a plus before it, which OBJ and STL allow.
inline std::from_chars_result number_from(const char* first, const char* last, double& value) {
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  return std::from_chars(first, last, value);
}

}  // namespace tensegric_fit::mesh_files
