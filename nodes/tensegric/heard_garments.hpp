/// Which `garment` messages were heard: a latched one is delivered again to a node that starts again or
/// forgot.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace tensegric_fit::node {

/// Names of publishers and stamps, nothing of a body.
class HeardGarments {
 public:
  /// `text`: from text(), of an earlier life; what is no such text is left out.
  explicit HeardGarments(const std::string& text = "");
  std::string text() const;

  /// False where this publisher's last message had this stamp, in nanoseconds: it is that message again.
  /// Messages without a stamp or publisher are always new.
  bool is_new(const std::string& publisher, std::uint64_t stamp);

 private:
  std::map<std::string, std::uint64_t> last_;
};

}  // namespace tensegric_fit::node
