#include "files/page_template.hpp"

#include <fstream>
#include <iterator>

#include "geometry/status.hpp"

namespace tensegric_fit::files {

std::string filled_in(const std::string& text, const std::map<std::string, std::string>& values) {
  std::string filled;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t open = text.find('[', at);
    const std::size_t close = open == std::string::npos ? open : text.find(']', open);
    if (close == std::string::npos) break;
    const auto value = values.find(text.substr(open + 1, close - open - 1));
    filled.append(text, at, open - at);
    at = value == values.end() ? open + 1 : close + 1;
    filled += value == values.end() ? "[" : value->second;
  }
  return filled.append(text, at, std::string::npos);
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad())
    throw geometry::Refusal(geometry::refusal::kBrokenFile, "'" + path + "' cannot be read");
  return bytes;
}

}  // namespace tensegric_fit::files
