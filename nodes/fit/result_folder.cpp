#include "fit/result_folder.hpp"

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "files/whole_folder.hpp"
#include "geometry/status.hpp"

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
  try {
    files::write_whole_file(path, text);
  } catch (const geometry::Refusal& refusal) {  // no input was refused
    throw std::runtime_error(refusal.what());
  }
}

void write_picture(const std::string& path, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  write_text(path, {bytes.begin(), bytes.end()});
}

void write_mesh(const std::string& path, const geometry::TriangleMesh& mesh,
                const std::vector<std::array<std::uint8_t, 3>>& colours, geometry::Coordinates coordinates) {
  write_text(path, geometry::ply_bytes(mesh, colours, coordinates));
}

void write_json(const fs::path& path, const nlohmann::ordered_json& json) {
  write_text(path.string(),
             json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace tensegric_fit::fit
