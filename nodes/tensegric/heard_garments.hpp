/// Which `garment` messages were heard: a latched one is delivered again to a node that starts again or
/// forgot.
#pragma once

#include <tensegric_fit/Garment.h>

#include <cstdint>
#include <map>
#include <string>

namespace tensegric_fit::node {

/// Names of publishers, stamps and checksums, nothing of a body.
class HeardGarments {
 public:
  /// `text`: from text(), of an earlier life; what is no such text is left out.
  explicit HeardGarments(const std::string& text = "");
  std::string text() const;

  /// False where it is this publisher's last message again, the same but for its sequence number: who changes
  /// a garment need not change its stamp. Messages without a stamp or publisher are always new.
  bool is_new(const std::string& publisher, const Garment& garment);

 private:
  struct Message {
    std::uint64_t stamp;  // ns
    std::uint64_t checksum;
  };
  std::map<std::string, Message> last_;
};

}  // namespace tensegric_fit::node
