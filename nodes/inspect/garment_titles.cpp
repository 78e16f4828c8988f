#include "inspect/garment_titles.hpp"

#include <algorithm>
#include <filesystem>

#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::inspect {
namespace {

// A file that is broken is refused when it is put on, in words; here it only has no title.
std::string text_in(const std::string& path, const char* key) {
  try {
    const YAML::Node value = geometry::load_yaml_map(path, geometry::refusal::kBadGarment)[key];
    return value && value.IsScalar() ? value.Scalar() : "";
  } catch (const geometry::Refusal&) {
    return "";
  }
}

}  // namespace

std::vector<GarmentTitle> garments_in(const std::string& folder) {
  std::vector<GarmentTitle> garments;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
    if (entry.is_regular_file() && entry.path().extension() == ".yaml") {
      const std::string file = entry.path().string();
      std::filesystem::path picture = entry.path();
      picture.replace_extension(".png");
      garments.push_back({entry.path().stem().string(), text_in(file, "title"), text_in(file, "about"),
                          std::filesystem::exists(picture, missing) ? picture.string() : ""});
    }
  std::sort(garments.begin(), garments.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return garments;
}

}  // namespace tensegric_fit::inspect
