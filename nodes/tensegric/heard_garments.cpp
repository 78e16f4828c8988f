#include "tensegric/heard_garments.hpp"

#include <fmt/format.h>
#include <ros/serialization.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace tensegric_fit::node {
namespace {

constexpr std::size_t kMost = 64;  // publishers; anonymous ones have another name each time

/// Not std::hash: what was heard outlives the process, and the build. rospy numbers a latched message anew
/// each time that it delivers it.
std::uint64_t checksum_of(Garment garment) {
  garment.header.seq = 0;
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(garment));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, garment);
  std::uint64_t value = 14695981039346656037u;
  for (const std::uint8_t byte : bytes) value = (value ^ byte) * 1099511628211u;
  return value;
}

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

bool HeardGarments::is_new(const std::string& publisher, const Garment& garment) {
  if (publisher.empty() || garment.header.stamp.isZero()) return true;
  const Message message{garment.header.stamp.toNSec(), checksum_of(garment)};
  const auto [found, is_first] = last_.emplace(publisher, message);
  if (!is_first && found->second.stamp == message.stamp && found->second.checksum == message.checksum)
    return false;
  found->second = message;
  if (last_.size() > kMost)
    last_.erase(std::min_element(last_.begin(), last_.end(), [](const auto& a, const auto& b) {
      return a.second.stamp < b.second.stamp;
    }));
  return true;
}

}  // namespace tensegric_fit::node
