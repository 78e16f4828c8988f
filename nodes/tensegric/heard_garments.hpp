/// Which `garment` messages were heard: a latched one is delivered again to a node that starts again or
/// forgot.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace tensegric_fit::node {

/// Names of publishers, stamps and checksums, nothing of a body.
class HeardGarments {
 public:
  /// `text`: from text(), of an earlier life; what is no such text is left out.
  explicit HeardGarments(const std::string& text = "");
  std::string text() const;

  /// A garment message by its stamp, in ns, and its checksum_of().
  struct Message {
    std::uint64_t stamp;
    std::uint64_t checksum;
  };

  /// False where it is this publisher's last message again: who changes a garment need not change its stamp.
  /// Without a stamp it is that as the first message that is heard of the publisher in this life. Messages
  /// without a publisher are always new.
  bool is_new(const std::string& publisher, const Message& message);

 private:
  std::map<std::string, Message> last_;
  std::set<std::string> in_this_life_;  // publishers that were heard
};

}  // namespace tensegric_fit::node
