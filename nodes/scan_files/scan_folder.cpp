#include "scan_files/scan_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "geometry/status.hpp"

namespace tensegric_fit::scan_files {

namespace fs = std::filesystem;

std::map<std::string, ScanFolder::Version> ScanFolder::look() const {
  std::map<std::string, Version> found;
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
      const std::string name = entry.path().filename().string();
      if (name.front() == '.') continue;
      std::error_code gone;  // meanwhile
      const bool regular = entry.is_regular_file(gone);
      const std::uintmax_t size = entry.file_size(gone);
      const fs::file_time_type changed = entry.last_write_time(gone);
      if (regular && !gone) found[name] = {changed.time_since_epoch().count(), size};
    }
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kBrokenFile,
                            path_ + ": the folder cannot be read: " + error.code().message());
  }
  return found;
}

std::vector<std::string> ScanFolder::poll(double now) {
  const std::map<std::string, Version> found = look();
  if (!found.empty())  // an empty folder may be where a share is mounted: it comes back with the same files
    for (auto file = files_.begin(); file != files_.end();)
      file = found.count(file->first) == 0 ? files_.erase(file) : std::next(file);
  std::vector<std::pair<std::int64_t, std::string>> complete;
  for (const auto& [name, version] : found) {
    const auto [file, is_new] = files_.try_emplace(name, File{version, now, false});
    if (!is_new && !(file->second.version == version)) file->second = {version, now, false};
    if (file->second.played || now - file->second.since < settle_) continue;
    file->second.played = true;
    complete.emplace_back(version.changed, name);
  }
  std::sort(complete.begin(), complete.end());
  std::vector<std::string> paths;
  for (const auto& [changed, name] : complete) paths.push_back((fs::path(path_) / name).string());
  return paths;
}

void ScanFolder::skip_all() {
  for (const auto& [name, version] : look()) files_[name] = {version, 0, true};
}

std::string ScanFolder::text_of(const std::string& name, const Version& version) {
  std::string text = fmt::format("{} {} ", version.changed, version.size);
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    text += byte < ' ' || byte > '~' || c == '%' ? fmt::format("%{:02x}", byte) : std::string(1, c);
  }
  return text;
}

std::string ScanFolder::text(const std::string& name) const {
  const auto file = files_.find(name);
  return text_of(name, file == files_.end() ? Version{} : file->second.version);
}

std::string ScanFolder::name_in(const std::string& text) {
  const std::string word = text.substr(text.find(' ', text.find(' ') + 1) + 1);  // 0 where there is no space
  std::string name;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const bool is_code = word[i] == '%' && i + 2 < word.size() && std::isxdigit(word[i + 1]) != 0 &&
                         std::isxdigit(word[i + 2]) != 0;
    name += is_code ? static_cast<char>(std::stoi(word.substr(i + 1, 2), nullptr, 16)) : word[i];
    if (is_code) i += 2;
  }
  return name;
}

std::vector<std::string> ScanFolder::played(const std::set<std::string>& but) const {
  std::vector<std::string> texts;
  for (const auto& [name, file] : files_)
    if (file.played && but.count(name) == 0) texts.push_back(text_of(name, file.version));
  return texts;
}

void ScanFolder::skip(const std::vector<std::string>& played) {
  for (const std::string& text : played) {
    std::istringstream words(text);
    Version version{};
    if (words >> version.changed >> version.size) files_[name_in(text)] = {version, 0, true};
  }
}

}  // namespace tensegric_fit::scan_files
