#include "batch/shard_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "geometry/json_text.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

using geometry::Refusal;
using Json = nlohmann::ordered_json;

bool is_text(const Json& value) {
  return value.is_string();
}

bool are_texts(const Json& value) {
  return value.is_array() && std::all_of(value.begin(), value.end(), is_text);
}

bool is_row(const Json& value) {
  return value.is_number_unsigned() && value != 0;
}

bool are_settings(const Json& value) {
  return value.is_object() && std::all_of(value.begin(), value.end(), are_texts);
}

bool is_reason(const Json& value) {
  return value.is_null() || (value.is_object() && is_text(value.value("code", Json())) &&
                             is_text(value.value("message", Json())));
}

/// Has what each line has, of the kind that it has there.
bool is_result(const Json& line) {
  constexpr std::array<std::pair<const char*, bool (*)(const Json&)>, 12> kParts{{{"row", is_row},
                                                                                  {"name", is_text},
                                                                                  {"key", is_text},
                                                                                  {"subject", is_text},
                                                                                  {"kind", is_text},
                                                                                  {"inputs", are_texts},
                                                                                  {"settings", are_settings},
                                                                                  {"manifest", is_text},
                                                                                  {"version", is_text},
                                                                                  {"build", is_text},
                                                                                  {"status", is_text},
                                                                                  {"reason", is_reason}}};
  return line.is_object() &&
         std::all_of(kParts.begin(), kParts.end(),
                     [&line](const auto& part) {
                       const auto found = line.find(part.first);
                       return found != line.end() && part.second(*found);
                     }) &&
         (line["status"] != "refused" || line["reason"].is_object());
}

Refusal cannot_write(const std::string& path, const std::string& why) {
  return Refusal(geometry::refusal::kCannotWrite, path + ": " + why);
}

}  // namespace

void for_each_line(const std::string& file, const std::function<void(Json&&, std::size_t)>& use) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Refusal(geometry::refusal::kBrokenFile, file + " cannot be read");
  std::size_t number = 0, place = 0;
  for (std::string text; std::getline(stream, text) && !stream.eof();) {
    ++number;
    Json line = geometry::json_in<Json>(text);
    if (!is_result(line))
      throw Refusal(geometry::refusal::kBrokenFile,
                    file + ", line " + std::to_string(number) + ": is not a result of a batch");
    use(std::move(line), place);
    place += text.size() + 1;
  }
}

bool is_unfinished(const Json& line) {
  const std::string status = line.at("status");
  if (status == "refused")  // the surface's process ran out of its time or memory, which were the machine's
    return line.at("reason").at("code") == geometry::refusal::kSurfaceFailed;
  return status == "crashed" || status == "timed_out" || status == "out_of_memory" || status == "failed";
}

ShardFile::ShardFile(const std::string& folder, const std::string& name) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  path_ = (std::filesystem::path(folder) / name).string();
  file_ =
      open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600);  // measures of persons
  if (file_ < 0) throw cannot_write(path_, std::strerror(errno));
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    close(file_);
    throw cannot_write(path_, "another fit_batch works on it");
  }
  cut_unfinished_line();
}

ShardFile::~ShardFile() {
  close(file_);
}

void ShardFile::cut_unfinished_line() const {
  std::array<char, 4096> block;
  off_t end = lseek(file_, 0, SEEK_END);
  const off_t size = end;
  while (end > 0) {
    const off_t start = std::max<off_t>(0, end - static_cast<off_t>(block.size()));
    const ssize_t n = pread(file_, block.data(), static_cast<std::size_t>(end - start), start);
    if (n <= 0) break;
    const std::string_view text(block.data(), static_cast<std::size_t>(n));
    if (const std::size_t last = text.rfind('\n'); last != std::string_view::npos) {
      end = start + static_cast<off_t>(last) + 1;
      break;
    }
    end = start;
  }
  if (end != size && ftruncate(file_, end) != 0) throw cannot_write(path_, std::strerror(errno));
}

std::size_t ShardFile::add(const Json& line) {
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  const off_t end = lseek(file_, 0, SEEK_END);
  const ssize_t written = ::write(file_, text.data(), text.size());
  if (written == static_cast<ssize_t>(text.size()) && fdatasync(file_) == 0)
    return static_cast<std::size_t>(end);
  const std::string why = written < 0 ? std::strerror(errno) : "the disk is full";
  if (ftruncate(file_, end) != 0) throw cannot_write(path_, why + "; an unfinished line is left");
  throw cannot_write(path_, why);
}

Json ShardFile::line_at(std::size_t place) const {
  std::ifstream stream(path_, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(place));
  std::string text;
  std::getline(stream, text);
  return Json::parse(text);
}

}  // namespace tensegric_fit::batch
