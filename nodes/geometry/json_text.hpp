/// JSON that others may have written.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace tensegric_fit::geometry {

/// Levels; what we write has a dozen. JSON is copied, compared and walked by recursion: lists in lists, a
/// million deep, would end the process.
inline constexpr int kDeepestJson = 64;

/// Of JSON: of other text it may say anything.
inline bool is_shallow_json(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') {
      quoted = !quoted;
    } else if (quoted) {
      i += c == '\\' ? 1 : 0;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepestJson) return false;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return true;
}

/// Discarded where it is no JSON or is nested more deeply. Not by the parser's callback: with one it takes
/// the square of the number of objects in a list.
template <typename Json = nlohmann::json>
Json json_in(std::string_view text) {
  return is_shallow_json(text) ? Json::parse(text, nullptr, false) : Json(Json::value_t::discarded);
}

}  // namespace tensegric_fit::geometry
