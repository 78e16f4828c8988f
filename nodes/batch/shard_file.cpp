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
#include <iterator>
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

bool is_object(const Json& value) {
  return value.is_object();
}

bool are_numbers(const Json& value) {
  return value.is_object() &&
         std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_number(); });
}

/// Seconds and megabytes, and milliseconds per stage.
bool are_costs(const Json& value) {
  if (!value.is_object()) return false;
  for (const auto& [name, cost] : value.items())
    if (name == "stages" ? !are_numbers(cost) : !cost.is_number()) return false;
  return true;
}

/// Of a line. Earlier builds wrote fewer.
struct Part {
  enum class Where { every_line, every_line_of_today, some_lines };
  const char* name;
  bool (*is)(const Json&);
  Where where;
};
using Where = Part::Where;

constexpr Part kParts[] = {{"row", is_row, Where::every_line},
                           {"key", is_text, Where::every_line},
                           {"status", is_text, Where::every_line},
                           {"name", is_text, Where::every_line_of_today},
                           {"subject", is_text, Where::every_line_of_today},
                           {"kind", is_text, Where::every_line_of_today},
                           {"inputs", are_texts, Where::every_line_of_today},
                           {"settings", are_settings, Where::every_line_of_today},
                           {"manifest", is_text, Where::some_lines},
                           {"version", is_text, Where::every_line_of_today},
                           {"build", is_text, Where::every_line_of_today},
                           {"reason", is_reason, Where::every_line_of_today},
                           {"result", is_object, Where::some_lines},
                           {"cost", are_costs, Where::some_lines}};

bool is_result(const Json& line) {
  if (!line.is_object()) return false;
  for (const Part& part : kParts) {
    const auto found = line.find(part.name);
    if (found == line.end() ? part.where == Where::every_line : !part.is(*found)) return false;
  }
  return line["status"] != "refused" || line.value("reason", Json()).is_object();
}

Refusal cannot_write(const std::string& path, const std::string& why) {
  return Refusal(geometry::refusal::kCannotWrite, path + ": " + why);
}

}  // namespace

void for_each_line(const std::string& file, const std::function<void(Json&&, std::size_t)>& use) {
  std::error_code unknown;
  std::ifstream stream;  // of a pipe it would wait for a writer
  if (std::filesystem::is_regular_file(file, unknown)) stream.open(file, std::ios::binary);
  if (!stream.is_open()) throw Refusal(geometry::refusal::kBrokenFile, file + " cannot be read");
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

bool has_all_parts(const Json& line) {
  return std::all_of(std::begin(kParts), std::end(kParts), [&line](const Part& part) {
    return part.where == Where::some_lines || line.contains(part.name);
  });
}

bool is_unfinished(const Json& line) {
  const std::string status = line.at("status");
  if (status == "refused")  // the surface's process ran out of its time or memory, which were the machine's
    return line.at("reason").at("code") == geometry::refusal::kSurfaceFailed;
  return status == "crashed" || status == "timed_out" || status == "out_of_memory" || status == "failed";
}

bool is_settled(const Json& line) {
  return line.at("key") != "" && !is_unfinished(line);
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
