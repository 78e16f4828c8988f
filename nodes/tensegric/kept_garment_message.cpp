#include "tensegric/kept_garment_message.hpp"

#include <fmt/format.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/checksum.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

// Ends the first garment's name; then the message, two hexadecimal digits a byte, and kOf with the scan_id of
// the body that it is of, if any.
constexpr char kEnd = '|', kOf = '@';

int digit_in(char digit) {
  const std::size_t value = std::string("0123456789abcdef").find(digit);
  if (value == std::string::npos) throw geometry::Refusal(geometry::refusal::kBadGarment, "no digit");
  return static_cast<int>(value);
}

std::vector<std::uint8_t> bytes_of(const Garment& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

}  // namespace

std::uint64_t checksum_of(Garment message) {
  message.header.seq = 0;
  const std::vector<std::uint8_t> bytes = bytes_of(message);
  return geometry::checksum(geometry::kEmptyChecksum, bytes.data(), bytes.size());
}

std::string kept_text(const std::string& first, const GarmentRequest& worn) {
  const std::vector<std::uint8_t> bytes = bytes_of(to_message({}, worn));
  return first + kEnd + fmt::format("{:02x}", fmt::join(bytes, "")) + (worn.of ? kOf + *worn.of : "");
}

std::optional<GarmentRequest> kept_garment(const std::string& text, const std::string& first) {
  const std::size_t end = text.rfind(kEnd);
  if (end == std::string::npos || text.substr(0, end) != first) return std::nullopt;
  try {
    const std::size_t of = std::min(text.find(kOf, end), text.size());
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = end + 1; i + 1 < of; i += 2)
      bytes.push_back(static_cast<std::uint8_t>(16 * digit_in(text[i]) + digit_in(text[i + 1])));
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    Garment message;
    ros::serialization::deserialize(stream, message);
    GarmentRequest request = request_in(message);
    if (of < text.size()) request.of = text.substr(of + 1);
    return request;
  } catch (const std::exception&) {  // of another version of the message
    return std::nullopt;
  }
}

}  // namespace tensegric_fit::node
