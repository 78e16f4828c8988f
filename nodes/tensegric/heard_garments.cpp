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
  while (words >> publisher >> message.stamp >> message.checksum)
    publishers_.push_back({publisher, message, false});
}

std::string HeardGarments::text() const {
  std::string text;
  for (const Publisher& publisher : publishers_)
    text += fmt::format("{} {} {} ", publisher.name, publisher.last.stamp, publisher.last.checksum);
  return text;
}

bool HeardGarments::is_new(const std::string& publisher, const Message& message) {
  if (publisher.empty()) return true;
  const auto known = std::find_if(publishers_.begin(), publishers_.end(),
                                  [&publisher](const Publisher& p) { return p.name == publisher; });
  bool is_again = false;
  if (known != publishers_.end()) {
    is_again = known->last.stamp == message.stamp && known->last.checksum == message.checksum &&
               (message.stamp != 0 || (message.latched && !known->heard_in_this_life));
    publishers_.erase(known);
  }
  publishers_.push_back({publisher, message, true});
  if (publishers_.size() > kMost) publishers_.erase(publishers_.begin());
  return !is_again;
}

}  // namespace tensegric_fit::node
