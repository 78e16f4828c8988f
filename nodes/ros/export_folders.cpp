#include "ros/export_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "files/whole_folder.hpp"
#include "geometry/status.hpp"
#include "ros/sealed.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;
using geometry::Refusal;

constexpr std::size_t kLargestDocument = 16 << 20;  // bytes; ours have some 20 kB

/// What marks a folder as an export of ours.
struct Mark {
  std::string scan_id;
  fs::file_time_type written;
};

std::optional<Mark> mark_in(const fs::path& folder) {
  if (fs::symlink_status(folder).type() != fs::file_type::directory) return std::nullopt;
  for (const char* name : {kFitDocument, kSealedDocument}) {
    const fs::path file = folder / name;
    if (fs::symlink_status(file).type() == fs::file_type::not_found) continue;
    const std::optional<std::string> text = files::bytes_of_plain_file(file, kLargestDocument);
    if (!text && fs::symlink_status(file).type() == fs::file_type::regular &&
        fs::file_size(file) <= kLargestDocument)
      throw Refusal(geometry::refusal::kCannotWrite,
                    fmt::format("'{}' cannot be read: whose it is is not known", file.string()));
    const std::optional<std::string> scan_id = text ? scan_id_in(*text) : std::nullopt;
    if (scan_id) return Mark{*scan_id, fs::last_write_time(folder / name)};
  }
  return std::nullopt;
}

bool is_of_an_export(const std::string& file) {
  return file == kSealedDocument || file == kSealedFile ||
         std::find(kExportFiles.begin(), kExportFiles.end(), file) != kExportFiles.end();
}

std::optional<fs::path> something_else_in(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.symlink_status().type() != fs::file_type::regular ||
        !is_of_an_export(entry.path().filename().string()))
      return entry.path();
  return std::nullopt;
}

void delete_export(const fs::path& folder) {
  if (const std::optional<fs::path> other = something_else_in(folder))
    throw Refusal(geometry::refusal::kBadOption,
                  fmt::format("'{}' is no part of an export: its folder was not deleted", other->string()));
  files::delete_whole_folder(folder);
}

/// What is left where writing or deleting an export was cut off may not say whose it is any more.
bool is_rest_of_an_export(const fs::path& folder) {
  return files::is_unfinished(folder.filename()) && !something_else_in(folder);
}

/// Whose a rest is, where that can still be read.
std::optional<Mark> mark_of_rest(const fs::path& folder) {
  try {
    return mark_in(folder);
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

/// Calls `take(folder, mark)` for each export in the folder, at any depth, those in an export first; links
/// are not followed. Rests of exports are deleted, whosever they are, and go to `take_rest(folder, mark)`,
/// whose mark may be gone. `left`: what cannot be looked at.
template <typename TakeRest, typename Take>
void for_each_export(const fs::path& directory, const TakeRest& take_rest, std::vector<Refusal>& left,
                     const Take& take) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  for (const fs::path& entry : entries) {
    try {
      if (fs::symlink_status(entry).type() != fs::file_type::directory) continue;
      if (is_rest_of_an_export(entry)) {
        const std::optional<Mark> mark = mark_of_rest(entry);
        files::delete_whole_folder(entry);
        take_rest(entry, mark);
      } else {
        const std::optional<Mark> mark = mark_in(entry);
        for_each_export(entry, take_rest, left, take);
        if (mark) take(entry, *mark);
      }
    } catch (const Refusal& refusal) {
      left.push_back(refusal);
    } catch (const fs::filesystem_error& error) {
      left.emplace_back(geometry::refusal::kCannotWrite,
                        fmt::format("'{}' cannot be looked at: {}", entry.string(), error.code().message()));
    }
  }
}

std::vector<fs::path> exports_of(const fs::path& directory, const std::string& scan_id, DeletedExports& gone,
                                 std::vector<Refusal>& left) {
  const std::optional<Mark> own = mark_in(directory);
  std::vector<fs::path> folders;
  const auto take_rest = [&](const fs::path& folder, const std::optional<Mark>& mark) {
    (mark && mark->scan_id == scan_id ? gone.exports : gone.rests).push_back(folder);
  };
  for_each_export(directory, take_rest, left, [&](const fs::path& folder, const Mark& mark) {
    if (mark.scan_id == scan_id) folders.push_back(folder);
  });
  if (own && own->scan_id == scan_id) folders.push_back(directory);
  return folders;
}

}  // namespace

void check_in_no_export(const std::string& directory) {
  const fs::path place = fs::weakly_canonical(fs::absolute(directory));  // it may go through links
  for (fs::path parent = place.parent_path(); parent != parent.parent_path(); parent = parent.parent_path())
    if (mark_in(parent))
      throw Refusal(geometry::refusal::kBadOption,
                    fmt::format("'{}' would lie in the export '{}', which takes no other files",
                                place.string(), parent.string()));
}

std::vector<std::string> lines_of(const DeletedExports& deleted) {
  std::vector<std::string> lines;
  for (const std::string& folder : deleted.exports) lines.push_back("export " + folder);
  for (const std::string& folder : deleted.rests)
    lines.push_back("rest of an export, perhaps of another scan: " + folder);
  return lines;
}

DeletedExports delete_exports(const std::string& directory, const std::string& scan_id,
                              std::vector<Refusal>& left) {
  fs::path place = fs::path(directory).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();  // a slash at the end
  if (!place.is_absolute() || scan_id.empty())
    throw Refusal(geometry::refusal::kBadOption, "which scan is to be deleted from which absolute path?");
  left.clear();
  DeletedExports gone;
  try {
    for (const fs::path& folder : exports_of(place, scan_id, gone, left)) {
      try {
        delete_export(folder);
        gone.exports.push_back(folder);
      } catch (const Refusal& refusal) {
        left.push_back(refusal);
      } catch (const fs::filesystem_error& error) {  // the vault may delete it as an old one meanwhile
        if (error.code() != std::errc::no_such_file_or_directory)
          left.emplace_back(geometry::refusal::kCannotWrite, folder.string() + ": " + error.code().message());
      }
    }
  } catch (const fs::filesystem_error& error) {
    throw Refusal(geometry::refusal::kCannotWrite,
                  fmt::format("'{}' cannot be looked at: {}", place.string(), error.code().message()));
  }
  if (gone.exports.empty() && gone.rests.empty() && left.empty())
    throw Refusal(geometry::refusal::kNothingYet,
                  fmt::format("no export of scan {} in '{}'", scan_id, place.string()));
  return gone;
}

std::vector<std::string> delete_old_exports(const std::string& directory, double days,
                                            std::vector<std::string>& left) {
  using Days = std::chrono::duration<double, std::ratio<86400>>;
  std::vector<std::string> gone;
  std::vector<Refusal> not_deleted;
  try {
    const auto take_rest = [&](const fs::path& folder, const std::optional<Mark>&) {
      gone.push_back(folder);
    };
    for_each_export(directory, take_rest, not_deleted, [&](const fs::path& folder, const Mark& mark) {
      if (Days(fs::file_time_type::clock::now() - mark.written).count() <= days) return;
      delete_export(folder);
      gone.push_back(folder);
    });
  } catch (const fs::filesystem_error& error) {
    left.push_back(fmt::format("'{}' cannot be looked at: {}", directory, error.code().message()));
  }
  for (const Refusal& refusal : not_deleted) left.emplace_back(refusal.what());
  return gone;
}

}  // namespace tensegric_fit::node
