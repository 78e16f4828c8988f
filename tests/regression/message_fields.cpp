#include "message_fields.hpp"

#include <cstring>
#include <set>
#include <sstream>
#include <stdexcept>

namespace tensegric_fit::regression {
namespace {

const std::set<std::string> kPlain = {"bool",    "int8",  "uint8",    "byte",  "char",   "int16",
                                      "uint16",  "int32", "uint32",   "int64", "uint64", "float32",
                                      "float64", "time",  "duration", "string"};

std::string package_of(const std::string& type) {
  return type.substr(0, type.find('/') + 1);
}

bool is_rule(const std::string& line) {
  return line.size() >= 10 && line.find_first_not_of('=') == std::string::npos;
}

}  // namespace

MessageReader::MessageReader(const std::string& type, const std::string& definition) : type_(type) {
  std::istringstream lines(definition);
  std::string current = type, text;
  for (std::string line; std::getline(lines, line);) {
    if (!is_rule(line)) {
      text += line + '\n';
      continue;
    }
    read(current, text);
    text.clear();
    if (std::getline(lines, line) && line.rfind("MSG: ", 0) == 0) current = line.substr(5);
  }
  read(current, text);
  resolve();
}

void MessageReader::read(const std::string& type, const std::string& text) {
  Entries& entries = types_[type];
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    Entry entry;
    // a constant is no field: `string CONVERGED=converged`
    if (!(words >> entry.type >> entry.name) || line.substr(0, line.find('#')).find('=') != std::string::npos)
      continue;
    const std::size_t bracket = entry.type.find('[');
    entry.count = kOne;
    if (bracket != std::string::npos) {
      const std::string count = entry.type.substr(bracket + 1, entry.type.find(']') - bracket - 1);
      entry.count = count.empty() ? kAny : std::stoi(count);
      entry.type.resize(bracket);
    }
    entries.push_back(entry);
  }
}

// Types are written as a message of the same package may write them: whole names from here on.
void MessageReader::resolve() {
  for (auto& [type, entries] : types_)
    for (Entry& entry : entries) {
      if (kPlain.count(entry.type) != 0) continue;
      const std::string candidates[] = {entry.type, package_of(type) + entry.type, "std_msgs/" + entry.type};
      bool found = false;
      for (const std::string& candidate : candidates)
        if (!found && types_.count(candidate) != 0) {
          entry.type = candidate;
          found = true;
        }
      if (!found) throw std::runtime_error(type_ + ": its definition does not name '" + entry.type + "'");
    }
}

class MessageReader::Walk {
 public:
  Walk(const MessageReader& reader, const std::vector<std::uint8_t>& bytes)
      : reader_(reader), bytes_(bytes) {}

  std::vector<Field> run() {
    std::vector<Field> fields;
    add(reader_.type_, "", fields);
    if (place_ != bytes_.size()) fail();
    return fields;
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error("the message is no " + reader_.type_); }

  template <typename Number>
  Number take() {
    if (bytes_.size() - place_ < sizeof(Number)) fail();
    Number number;
    std::memcpy(&number, &bytes_[place_], sizeof number);
    place_ += sizeof number;
    return number;
  }

  double number(const std::string& type) {
    if (type == "bool" || type == "uint8" || type == "char") return take<std::uint8_t>();
    if (type == "int8" || type == "byte") return take<std::int8_t>();
    if (type == "int16") return take<std::int16_t>();
    if (type == "uint16") return take<std::uint16_t>();
    if (type == "int32") return take<std::int32_t>();
    if (type == "uint32") return take<std::uint32_t>();
    if (type == "int64") return static_cast<double>(take<std::int64_t>());
    if (type == "uint64") return static_cast<double>(take<std::uint64_t>());
    if (type == "float32") return take<float>();
    if (type == "float64") return take<double>();
    if (type == "time") {
      const double seconds = take<std::uint32_t>();
      return seconds + 1e-9 * take<std::uint32_t>();
    }
    const double seconds = take<std::int32_t>();  // a duration
    return seconds + 1e-9 * take<std::int32_t>();
  }

  std::string word() {
    const auto size = take<std::uint32_t>();
    if (bytes_.size() - place_ < size) fail();
    const std::string text(bytes_.begin() + static_cast<long>(place_),
                           bytes_.begin() + static_cast<long>(place_ + size));
    place_ += size;
    return text;
  }

  void add(const std::string& type, const std::string& path, std::vector<Field>& fields) {
    for (const Entry& entry : reader_.types_.at(type)) {
      const std::string name = path.empty() ? entry.name : path + "." + entry.name;
      const std::uint32_t count = entry.count == kOne   ? 1
                                  : entry.count == kAny ? take<std::uint32_t>()
                                                        : static_cast<std::uint32_t>(entry.count);
      if (kPlain.count(entry.type) != 0)
        add_plain(entry.type, name, count, fields);
      else if (entry.count == kOne)
        add(entry.type, name, fields);
      else
        for (std::uint32_t i = 0; i < count; ++i) add_element(entry.type, name, i, fields);
    }
  }

  void add_plain(const std::string& type, const std::string& name, std::uint32_t count,
                 std::vector<Field>& fields) {
    Field field{name, {}, {}};
    for (std::uint32_t i = 0; i < count; ++i)
      if (type == "string")
        field.words.push_back(word());
      else
        field.numbers.push_back(number(type));
    fields.push_back(std::move(field));
  }

  void add_element(const std::string& type, const std::string& name, std::uint32_t i,
                   std::vector<Field>& fields) {
    std::vector<Field> own;
    add(type, "", own);
    std::string key = std::to_string(i);
    if (!own.empty() && own[0].words.size() == 1 && !own[0].words[0].empty()) key = own[0].words[0];
    for (Field& field : own) {
      field.path = name + "[" + key + "]." + field.path;
      fields.push_back(std::move(field));
    }
  }

  const MessageReader& reader_;
  const std::vector<std::uint8_t>& bytes_;
  std::size_t place_ = 0;
};

std::vector<Field> MessageReader::fields_of(const std::vector<std::uint8_t>& bytes) const {
  return Walk(*this, bytes).run();
}

}  // namespace tensegric_fit::regression
