#include "tensegric/heard_garments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace tensegric_fit::node {
namespace {

constexpr std::size_t kMost = 64;  // publishers; anonymous ones have another name each time

}  // namespace

HeardGarments::HeardGarments(const std::string& text) {
  std::istringstream words(text);
  std::string publisher;
  std::uint64_t stamp = 0;
  while (words >> publisher >> stamp) last_[publisher] = stamp;
}

std::string HeardGarments::text() const {
  std::string text;
  for (const auto& [publisher, stamp] : last_) text += fmt::format("{} {} ", publisher, stamp);
  return text;
}

bool HeardGarments::is_new(const std::string& publisher, std::uint64_t stamp) {
  if (publisher.empty() || stamp == 0) return true;
  const auto [found, is_first] = last_.emplace(publisher, stamp);
  if (!is_first && found->second == stamp) return false;
  found->second = stamp;
  if (last_.size() > kMost)
    last_.erase(std::min_element(last_.begin(), last_.end(),
                                 [](const auto& a, const auto& b) { return a.second < b.second; }));
  return true;
}

}  // namespace tensegric_fit::node
