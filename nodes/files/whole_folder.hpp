/// Folders and files that are written atomically, complete or not at all, and readable by their owner only.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tensegric_fit::files {

struct FileContent {
  std::string name;  ///< within the folder
  std::string bytes;
};

/// To be called before a long computation of what goes into it. \throw Refusal bad_option: the path is
/// relative, or there is something already
void check_new_folder(const std::string& folder);

/// Writes the files into a hidden folder beside `folder` that takes its name when all are on the disk,
/// whatever happens meanwhile; remains of one that was interrupted are removed by the next with files of the
/// same names. Returns the files' paths. \throw Refusal bad_option: the path is relative, or there is
/// something already; cannot_write, in words
std::vector<std::string> write_whole_folder(const std::string& folder, const std::vector<FileContent>& files);

/// Whether a folder's name is that of one that is being written or deleted, or was when that was cut off.
bool is_unfinished(const std::string& name);

/// Takes the folder away at once and deletes it with its files; a link in it goes, what it leads to stays.
/// \pre an absolute path \throw Refusal cannot_write: a link, or a folder with folders in it
void delete_whole_folder(const std::string& folder);

/// Replaces what has that name, a link as well. \throw Refusal cannot_write
void write_whole_file(const std::string& path, const std::string& bytes);

/// What is in a file of `most` bytes at most; nothing of a link, a pipe, a larger file, or none.
std::optional<std::string> bytes_of_plain_file(const std::string& path, std::size_t most);

}  // namespace tensegric_fit::files
