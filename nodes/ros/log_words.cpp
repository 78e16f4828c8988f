#include "ros/log_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = "(file)";
constexpr std::array<const char*, 10> kEndings = {".bag", ".ply", ".pcd",  ".xyz",  ".obj",
                                                  ".stl", ".glb", ".gltf", ".json", ".html"};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Topics look like paths, but there is no folder where they begin.
bool is_file(const std::string& word) {
  std::error_code unknown;
  if (word.size() > 1 && word.front() == '/')
    return fs::is_directory(word.substr(0, word.find('/', 1)), unknown);
  return std::any_of(kEndings.begin(), kEndings.end(), [&](const std::string& ending) {
    return word.size() > ending.size() &&
           word.compare(word.size() - ending.size(), ending.size(), ending) == 0;
  });
}

std::string without_files(const std::string& sentence) {
  std::string words;
  for (std::size_t i = 0; i < sentence.size();) {
    const bool quoted = i > 0 && sentence[i - 1] == '\'';
    const bool begins = i == 0 || quoted || std::isspace(static_cast<unsigned char>(sentence[i - 1])) != 0 ||
                        sentence[i - 1] == '(';
    std::size_t end =
        begins ? std::min(sentence.find_first_of(quoted ? "'" : " \t\n',;()", i), sentence.size()) : i;
    if (!quoted)
      while (end > i && (sentence[end - 1] == ':' || sentence[end - 1] == '.')) --end;  // of the sentence
    if (end > i && is_file(sentence.substr(i, end - i))) {
      words += kFile;
      i = end;
    } else {
      words += sentence[i++];
    }
  }
  return words;
}

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

}  // namespace

std::string log_words(const std::string& sentence) {
  return without_figures(without_files(sentence));
}

}  // namespace tensegric_fit::node
