#include "ros/log_words.hpp"

#include <cctype>

namespace tensegric_fit::node {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

}  // namespace

std::string without_figures(const std::string& sentence) {
  std::string words;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    if (!is_digit(sentence[i]) || (i > 0 && is_of_name(sentence[i - 1]))) {
      words += sentence[i];
      continue;
    }
    words += '#';
    const auto goes_on = [&](std::size_t next) {
      return next < sentence.size() &&
             (is_digit(sentence[next]) || ((sentence[next] == '.' || sentence[next] == ',') &&
                                           next + 1 < sentence.size() && is_digit(sentence[next + 1])));
    };
    while (goes_on(i + 1)) ++i;
  }
  return words;
}

}  // namespace tensegric_fit::node
