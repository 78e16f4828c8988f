#include "geometry/shipped_files.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

namespace fs = std::filesystem;

std::string names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

}  // namespace

std::string shipped_folder(const std::string& name) {
  const fs::path launch = fs::path("share/tensegric_fit/launch");
  Dl_info library{};
  fs::path folder;
  if (dladdr(reinterpret_cast<const void*>(&shipped_folder), &library) != 0)
    folder = fs::absolute(library.dli_fname).lexically_normal().parent_path();
  std::error_code unreadable;
  while (folder.has_relative_path() && !fs::is_directory(folder / launch, unreadable))
    folder = folder.parent_path();
  return (folder / launch / name).string();
}

std::string yaml_file(const std::string& folder, const std::string& word, const std::string& code) {
  const fs::path given(word);
  const bool named = !given.has_parent_path() && given.extension() != ".yaml";
  const fs::path file = named ? fs::path(folder) / (word + ".yaml") : given;
  std::error_code unreadable;
  if (word.empty() || !fs::is_regular_file(file, unreadable))
    throw Refusal(code, named ? "there is no '" + word + "' in '" + folder + "', only: " + names_in(folder)
                              : "there is no file '" + word + "'");
  return file.string();
}

std::vector<std::string> joined_words(const std::string& words) {
  std::error_code unreadable;
  if (fs::is_regular_file(words, unreadable)) return {words};
  std::vector<std::string> parts;
  for (std::size_t start = 0; start <= words.size();) {
    const std::size_t end = std::min(words.find('+', start), words.size());
    parts.push_back(words.substr(start, end - start));
    start = end + 1;
  }
  return parts;
}

}  // namespace tensegric_fit::geometry
