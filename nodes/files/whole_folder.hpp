/// Folders that are written atomically: complete or not at all.
#pragma once

#include <string>
#include <vector>

namespace tensegric_fit::files {

struct FileContent {
  std::string name;  ///< within the folder
  std::string bytes;
};

/// For whoever has long to compute what goes into it. \throw Refusal bad_option: the path is relative, or
/// there is something already
void check_new_folder(const std::string& folder);

/// Writes the files into a hidden folder beside `folder` that takes its name when all are on the disk,
/// whatever happens meanwhile; remains of one that was interrupted are removed by the next. Returns the
/// files' paths. \throw Refusal bad_option: the path is relative, or there is something already;
/// cannot_write, in words
std::vector<std::string> write_whole_folder(const std::string& folder, const std::vector<FileContent>& files);

/// Takes the folder away at once and deletes it. \pre an absolute path \throw Refusal cannot_write
void delete_whole_folder(const std::string& folder);

}  // namespace tensegric_fit::files
