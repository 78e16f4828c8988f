/// Which `garment` messages were heard: a latched one is delivered again to a node that starts again or
/// forgot.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tensegric_fit::node {

/// Names of publishers, stamps and checksums, nothing of a body.
class HeardGarments {
 public:
  /// `text`: from text(), of an earlier life; what is no such text is left out.
  explicit HeardGarments(const std::string& text = "");
  std::string text() const;

  /// A garment message by its stamp, in ns, and its checksum_of(); `latched`: by its publisher.
  struct Message {
    std::uint64_t stamp;
    std::uint64_t checksum;
    bool latched = false;
  };

  /// False where it is this publisher's last message again: who changes a garment need not change its stamp.
  /// A message without a stamp counts as that only if it is latched and the first from this publisher since
  /// the node started. Messages without a publisher are always new.
  bool is_new(const std::string& publisher, const Message& message);

 private:
  struct Publisher {
    std::string name;
    Message last;
    bool heard_in_this_life;
  };
  std::vector<Publisher> publishers_;  // who was heard last comes last
};

}  // namespace tensegric_fit::node
