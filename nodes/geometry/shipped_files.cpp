#include "geometry/shipped_files.hpp"

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
  // lib/tensegric_fit/<program> -> share/tensegric_fit/launch/<name>
  return (fs::read_symlink("/proc/self/exe").parent_path() / "../../share/tensegric_fit/launch" / name)
      .lexically_normal()
      .string();
}

std::string yaml_file(const std::string& folder, const std::string& word, const std::string& code) {
  const fs::path given(word);
  const bool named = !given.has_parent_path() && given.extension() != ".yaml";
  const fs::path file = named ? fs::path(folder) / (word + ".yaml") : given;
  std::error_code unreadable;
  if (word.empty() || !fs::is_regular_file(file, unreadable))
    throw Refusal(code, named ? "there is no '" + word + "' in " + folder + ", only: " + names_in(folder)
                              : "there is no file '" + word + "'");
  return file.string();
}

}  // namespace tensegric_fit::geometry
