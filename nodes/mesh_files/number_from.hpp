/// A number of a text file.
#pragma once

#include <charconv>

namespace tensegric_fit::mesh_files {

/// As std::from_chars, and with a plus before it, which OBJ and STL allow.
inline std::from_chars_result number_from(const char* first, const char* last, double& value) {
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  return std::from_chars(first, last, value);
}

}  // namespace tensegric_fit::mesh_files
