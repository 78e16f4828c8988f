/// JSON that others may have written.
#pragma once

#include <nlohmann/json.hpp>

namespace tensegric_fit::geometry {

/// Levels; what we write has a dozen. JSON is copied, compared and walked by recursion: lists in lists, a
/// million deep, would end the process.
inline constexpr int kDeepestJson = 64;

/// Discarded where it is no JSON or is nested more deeply. `source`: text or a stream.
template <typename Json = nlohmann::json, typename Source>
Json json_in(Source&& source) {
  bool too_deep = false;
  const auto look = [&too_deep](int depth, typename Json::parse_event_t, const Json&) {
    too_deep |= depth > kDeepestJson;
    return !too_deep;
  };
  Json json = Json::parse(source, look, false);
  return too_deep ? Json(Json::value_t::discarded) : json;
}

}  // namespace tensegric_fit::geometry
