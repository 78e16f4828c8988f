/// Are the arrays of a serialized ROS message as long as it says?
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tensegric_fit::files {

/// roscpp makes room for an array before it looks whether its bytes are there: a message of 100 bytes can ask
/// for all memory. This looks first.
class MessageLayout {
 public:
  /// \param definition of the message, with those of its parts below lines of =, as ros::message_traits has
  /// it
  explicit MessageLayout(const std::string& definition);

  /// \param message serialized (wiki.ros.org/roscpp/Overview/MessagesSerializationAndAdaptingTypes) \throw
  /// Refusal broken_file: it ends before its arrays and texts do
  void check(std::string_view message) const;

 private:
  struct Field {
    std::string part;  ///< type of the entries; empty: numbers or a text
    std::size_t size;  ///< bytes of a number; 0: a text or a part
    long count;        ///< entries; of a list that states its length: -1
  };
  using Fields = std::vector<Field>;

  static Field field_of(const std::string& type);
  const Fields& fields_of(const std::string& part) const;
  void skip(const Fields& fields, std::string_view& rest) const;

  std::map<std::string, Fields> parts_;  // by package/Type; the message itself: ""
};

}  // namespace tensegric_fit::files
