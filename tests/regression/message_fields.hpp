/// The fields of recorded messages by name, of whatever version: read by the definition that travels with
/// them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tensegric_fit::regression {

/// One field of a message: `girths[bust].value`. An array of plain values is one field.
struct Field {
  std::string path;
  std::vector<double> numbers;     ///< of numbers, flags, times (seconds)
  std::vector<std::string> words;  ///< of texts; one of both lists is empty
};

/// Reads messages of one type.
class MessageReader {
 public:
  /// `type`: package/Name; `definition`: as in a bag, with the types that it is made of. \throw
  /// std::runtime_error: a definition that does not name all its types
  MessageReader(const std::string& type, const std::string& definition);

  /// In the order of the definition. Elements of arrays of messages are named by their first word, or
  /// counted. \throw std::runtime_error: the bytes are not of this type
  std::vector<Field> fields_of(const std::vector<std::uint8_t>& bytes) const;

 private:
  struct Entry {
    std::string type, name;
    int count;  ///< of an array; kOne, kAny
  };
  static constexpr int kOne = -1, kAny = -2;
  using Entries = std::vector<Entry>;
  class Walk;

  void read(const std::string& type, const std::string& text);
  void resolve();

  std::string type_;
  std::map<std::string, Entries> types_;
};

}  // namespace tensegric_fit::regression
