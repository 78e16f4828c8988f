#include "ros/log_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "geometry/status.hpp"

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

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// Topics look like paths, but there is no folder where they begin.
bool is_path(const std::string& word) {
  std::error_code unknown;
  return word.size() > 1 && word.front() == '/' &&
         fs::is_directory(word.substr(0, word.find('/', 1)), unknown);
}

bool is_name_of_file(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(kEndings.begin(), kEndings.end(), [&](const std::string& ending) {
    return word.size() > ending.size() &&
           word.compare(word.size() - ending.size(), ending.size(), ending) == 0;
  });
}

/// The end of a path that begins there, which may have blanks and commas in it: at its closing quote or
/// bracket, or where a sentence about it goes on.
std::size_t end_of_path(const std::string& sentence, std::size_t begin) {
  const char before = begin > 0 ? sentence[begin - 1] : ' ';
  const char closing = before == '[' ? ']' : before == '(' ? ')' : before;
  const auto ends = [&](std::size_t at) {
    const bool last = at + 1 == sentence.size() || !is_of_name(sentence[at + 1]);
    if (!is_blank(before) && before != '=') return sentence[at] == closing && last;
    return (sentence[at] == ':' || sentence[at] == ';') && last;
  };
  std::size_t end = begin;
  while (end < sentence.size() && !ends(end)) ++end;
  return end == sentence.size() && sentence.back() == '.' ? end - 1 : end;
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

std::string without_files(const std::string& sentence) {
  const std::string openings = "'\"([=", breaks = " \t\n'\",;()[]";
  std::string words;
  for (std::size_t i = 0; i < sentence.size();) {
    const bool begins =
        i == 0 || is_blank(sentence[i - 1]) || openings.find(sentence[i - 1]) != std::string::npos;
    std::size_t end = i;
    if (begins) {
      end = std::min(sentence.find_first_of(breaks, i), sentence.size());
      while (end > i && (sentence[end - 1] == ':' || sentence[end - 1] == '.')) --end;  // of the sentence
    }
    const std::string word = sentence.substr(i, end - i);
    if (is_path(word)) {
      words += kFile;
      i = end_of_path(sentence, i);
    } else if (is_name_of_file(word)) {
      words += kFile;
      i = end;
    } else {
      words += sentence[i++];
    }
  }
  return words;
}

std::string log_words(const std::string& sentence) {
  const std::size_t which = sentence.find(geometry::refusal::kMissingPart);
  const std::string words = without_figures(without_files(sentence.substr(0, which)));
  return which == std::string::npos ? words : words + geometry::refusal::kMissingPart;
}

}  // namespace tensegric_fit::node
