#include "files/csv.hpp"

namespace tensegric_fit::files {

bool read_csv_row(std::istream& stream, std::vector<std::string>& fields, std::size_t& line) {
  fields.clear();
  if (stream.tellg() == std::streampos(0) && stream.peek() == 0xEF) stream.ignore(3);
  if (stream.peek() == std::istream::traits_type::eof()) return false;
  fields.emplace_back();
  bool quoted = false;
  for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
    if (c == '"' && quoted && stream.peek() == '"') {
      fields.back() += static_cast<char>(stream.get());
    } else if (c == '"') {
      quoted = !quoted;
    } else if (quoted) {
      line += c == '\n' ? 1 : 0;
      fields.back() += static_cast<char>(c);
    } else if (c == ',') {
      fields.emplace_back();
    } else if (c == '\n') {
      break;
    } else if (c != '\r') {
      fields.back() += static_cast<char>(c);
    }
  }
  return true;
}

}  // namespace tensegric_fit::files
