#include "fit/result_folder.hpp"

#include <fstream>
#include <stdexcept>

namespace tensegric_fit::fit {

namespace fs = std::filesystem;

void remove_results(const fs::path& folder, const ResultNames& names) {
  std::error_code not_there;
  for (const char* name : names) fs::remove(folder / name, not_there);
}

const std::string* endangered_input(const std::vector<const std::string*>& inputs, const fs::path& folder,
                                    const ResultNames& names) {
  std::error_code not_there;
  for (const std::string* input : inputs)
    for (const char* name : names)
      if (fs::equivalent(*input, folder / name, not_there)) return input;
  return nullptr;
}

void write_text(const std::string& path, const std::string& text) {
  const std::string unfinished = path + ".part";
  std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw std::runtime_error(path + ": cannot be written");
  }
  fs::rename(unfinished, path);
}

void write_json(const fs::path& path, const nlohmann::ordered_json& json) {
  write_text(path.string(),
             json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace tensegric_fit::fit
