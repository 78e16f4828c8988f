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
  Message message{0, 0};
  while (words >> publisher >> message.stamp >> message.checksum) last_[publisher] = message;
}

std::string HeardGarments::text() const {
  std::string text;
  for (const auto& [publisher, message] : last_)
    text += fmt::format("{} {} {} ", publisher, message.stamp, message.checksum);
  return text;
}

bool HeardGarments::is_new(const std::string& publisher, const Message& message) {
  if (publisher.empty()) return true;
  const bool was_heard = !in_this_life_.insert(publisher).second;
  const auto [found, is_first] = last_.emplace(publisher, message);
  if (!is_first && found->second.stamp == message.stamp && found->second.checksum == message.checksum &&
      (message.stamp != 0 || !was_heard))
    return false;
  found->second = message;
  if (last_.size() > kMost)
    last_.erase(std::min_element(last_.begin(), last_.end(), [](const auto& a, const auto& b) {
      return a.second.stamp < b.second.stamp;
    }));
  return true;
}

}  // namespace tensegric_fit::node
