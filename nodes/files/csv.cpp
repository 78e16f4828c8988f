#include "files/csv.hpp"

namespace tensegric_fit::files {

bool read_csv_row(std::istream& stream, std::vector<std::string>& fields, std::size_t& line) {
  fields.clear();
  if (stream.tellg() == std::streampos(0) && stream.peek() == 0xEF) stream.ignore(3);
  if (stream.peek() == std::istream::traits_type::eof()) return false;
  fields.emplace_back();
  bool quoted = false, closed = false;  // in quotes; after a field in quotes
  for (int c = stream.get(); c != std::istream::traits_type::eof(); c = stream.get()) {
    if (c == '"' && quoted && stream.peek() == '"') {
      fields.back() += static_cast<char>(stream.get());
    } else if (c == '"' && quoted) {
      quoted = false;
      closed = true;
    } else if (c == '"') {
      if (closed || !fields.back().empty())
        throw CsvFault("has a quote within a field that does not begin with one");
      quoted = true;
    } else if (quoted) {
      line += c == '\n' ? 1 : 0;
      fields.back() += static_cast<char>(c);
    } else if (c == ',') {
      fields.emplace_back();
      closed = false;
    } else if (c == '\n') {
      return true;
    } else if (c != '\r') {
      if (closed) throw CsvFault("has text after a field in quotes");
      fields.back() += static_cast<char>(c);
    }
  }
  if (quoted) throw CsvFault("has a field whose quotes are not closed");
  return true;
}

}  // namespace tensegric_fit::files
