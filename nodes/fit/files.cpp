#include "fit/files.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "geometry/status.hpp"

namespace tensegric_fit::fit {
namespace {

namespace fs = std::filesystem;

// lib/tensegric_fit/fit -> share/tensegric_fit/launch/<folder>
fs::path shipped(const std::string& folder) {
  return fs::read_symlink("/proc/self/exe").parent_path() / "../../share/tensegric_fit/launch" / folder;
}

std::string names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

std::string garment_file(const std::string& word) {
  const fs::path given(word);
  if (given.extension() == ".yaml" || given.has_parent_path()) return word;
  const fs::path file = shipped("garments") / (word + ".yaml");
  if (!fs::exists(file))
    throw geometry::Refusal(
        geometry::refusal::kBadGarment,
        "no garment is called '" + word + "'; there are " + names_in(shipped("garments")));
  return file.string();
}

std::string template_file(const std::string& region) {
  const fs::path file = shipped("templates") / (region + ".yaml");
  if (!fs::exists(file))
    throw geometry::Refusal(geometry::refusal::kBadGarment, "no control mesh template covers the region '" +
                                                                region + "'; there are " +
                                                                names_in(shipped("templates")));
  return file.string();
}

}  // namespace tensegric_fit::fit
