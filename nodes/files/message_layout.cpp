#include "files/message_layout.hpp"

#include <sstream>

#include "files/byte_reader.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

/// 0: no number.
std::size_t size_of(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes{
      {"bool", 1},   {"byte", 1},    {"char", 1},    {"int8", 1},   {"uint8", 1},
      {"int16", 2},  {"uint16", 2},  {"int32", 4},   {"uint32", 4}, {"int64", 8},
      {"uint64", 8}, {"float32", 4}, {"float64", 8}, {"time", 8},   {"duration", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

}  // namespace

MessageLayout::MessageLayout(const std::string& definition) {
  std::istringstream lines(definition);
  Fields* fields = &parts_[""];
  for (std::string line; std::getline(lines, line);) {
    const std::string code = line.substr(0, line.find('#'));
    std::istringstream words(code);
    std::string type, name;
    if (!(words >> type >> name)) continue;  // a comment, or a line of =
    if (type == "MSG:")
      fields = &parts_[name];
    else if (code.find('=') == std::string::npos)  // else a constant
      fields->push_back(field_of(type));
  }
}

MessageLayout::Field MessageLayout::field_of(const std::string& type) {
  const std::size_t bracket = type.find('[');
  const std::string entry = type.substr(0, bracket);
  long count = 1;
  if (bracket != std::string::npos)
    count = type[bracket + 1] == ']' ? -1 : std::stol(type.substr(bracket + 1));
  const std::size_t size = size_of(entry);
  return {size > 0 || entry == "string" ? "" : entry == "Header" ? "std_msgs/Header" : entry, size, count};
}

/// Types of the same package are named without it.
const MessageLayout::Fields& MessageLayout::fields_of(const std::string& part) const {
  const std::string ending = "/" + part;
  for (const auto& [name, fields] : parts_) {
    const bool ends =
        name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
    if (name == part || ends) return fields;
  }
  throw Fault{"is of a type that is not known whole"};
}

void MessageLayout::skip(const Fields& fields, Bytes& rest) const {
  for (const Field& field : fields) {
    const std::uint64_t count = field.count < 0 ? take_length(rest) : static_cast<std::uint64_t>(field.count);
    if (field.size > 0) {
      take(rest, count * field.size);
      continue;
    }
    const Fields* entries = field.part.empty() ? nullptr : &fields_of(field.part);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (entries == nullptr)
        take_block(rest);
      else
        skip(*entries, rest);
    }
  }
}

void MessageLayout::check(Bytes message) const {
  try {
    skip(parts_.at(""), message);
  } catch (const Fault& fault) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "a message " + fault.what);
  }
}

}  // namespace tensegric_fit::files
