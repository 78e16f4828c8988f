/// CSV files (RFC 4180).
#pragma once

#include <istream>
#include <stdexcept>
#include <string>
#include <vector>

namespace tensegric_fit::files {

/// A field, in quotes where it would read as more than one.
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// A text of somebody else's, which spreadsheets would take for a formula where it begins like one: with '
/// before it, as OWASP recommends.
inline std::string no_formula(const std::string& text) {
  return !text.empty() && std::string("=+-@\t\r").find(text[0]) != std::string::npos ? "'" + text : text;
}

/// What a row has wrong, in words that follow its line's number.
struct CsvFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The next row's fields; `line` grows by the line ends that lie in quotes. False: there is none. A byte
/// order mark is skipped. \throw CsvFault: a quote within a field, text after one in quotes, a quote left
/// open
bool read_csv_row(std::istream& stream, std::vector<std::string>& fields, std::size_t& line);

}  // namespace tensegric_fit::files
