/// Words of an enum's values, as parameters, messages and reports have them.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tensegric_fit::geometry {

/// One word a value, in the order of the values, which are 0 to N - 1.
template <typename Enum, std::size_t N>
struct EnumWords {
  std::array<const char*, N> words;

  std::string of(Enum value) const { return words.at(static_cast<std::size_t>(value)); }
  std::vector<std::string> all() const { return {words.begin(), words.end()}; }
  /// Nothing where no value has that word.
  std::optional<Enum> find(const std::string& word) const {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) return std::nullopt;
    return static_cast<Enum>(found - words.begin());
  }
};

}  // namespace tensegric_fit::geometry
