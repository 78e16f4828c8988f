#include "files/whole_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <set>
#include <system_error>
#include <thread>

#include "files/descriptor.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

namespace fs = std::filesystem;

constexpr char kUnfinished[] = ".unfinished";      // suffix of hidden folders
constexpr char kPart[] = ".part";                  // of files
constexpr std::chrono::seconds kLockPatience(30);  // an export to a slow disk takes some seconds

fs::path hidden(const fs::path& folder) {
  return folder.parent_path() / ("." + folder.filename().string() + kUnfinished);
}

/// The parent may be reached by a link, the folders in it not.
fs::path parent_of(const fs::path& folder) {
  return fs::canonical(folder.parent_path());
}

/// Files in it and the folder; never what a link in it leads to. \throw filesystem_error: a folder in it
void remove_folder(const Descriptor& parent, const fs::path& folder) {
  const std::string name = folder.filename();
  {
    const Descriptor directory(parent, name, O_RDONLY | O_DIRECTORY);
    std::vector<std::string> entries;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(fmt::format("/proc/self/fd/{}", directory.number())))
      entries.push_back(entry.path().filename());
    for (const std::string& entry : entries)
      if (unlinkat(directory.number(), entry.c_str(), 0) != 0) fail(folder / entry);
  }
  if (unlinkat(parent.number(), name.c_str(), AT_REMOVEDIR) != 0) fail(folder);
}

using Names = std::set<std::string>;

Names names_in(const fs::path& folder) {
  Names names;
  if (fs::symlink_status(folder).type() == fs::file_type::directory)
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      names.insert(entry.path().filename());
  return names;
}

/// Held by one writer at a time; unfinished folders that exist when it is acquired were abandoned. Those that
/// hold nothing but files of `names` are removed: others may be somebody else's.
class LockedParent {
 public:
  LockedParent(const fs::path& parent, const Names& names) : directory_(parent, O_RDONLY | O_DIRECTORY) {
    lock(parent);
    for (const fs::directory_entry& entry : fs::directory_iterator(parent)) {
      if (is_unfinished(entry.path().filename()) && entry.symlink_status().type() == fs::file_type::directory)
        try {
          const Names there = names_in(entry.path());
          if (std::includes(names.begin(), names.end(), there.begin(), there.end()))
            remove_folder(directory_, entry.path());
        } catch (const fs::filesystem_error&) {  // another user's, or not ours: only a folder of its name
                                                 // cannot be written
        }
    }
  }

  const Descriptor& directory() const { return directory_; }

  void rename(const fs::path& from, const fs::path& to) const {
    if (renameat(directory_.number(), from.filename().c_str(), directory_.number(), to.filename().c_str()) !=
        0)
      fail(to);
  }

 private:
  /// Who holds it may be stopped, and must not stop others.
  void lock(const fs::path& parent) const {
    const auto end = std::chrono::steady_clock::now() + kLockPatience;
    while (flock(directory_.number(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EINTR && (errno != EWOULDBLOCK || std::chrono::steady_clock::now() > end)) fail(parent);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  const Descriptor directory_;
};

void write_files(const LockedParent& parent, const fs::path& unfinished,
                 const std::vector<FileContent>& files) {
  // one that is there already, or a link, is somebody else's
  if (mkdirat(parent.directory().number(), unfinished.filename().c_str(), S_IRWXU) != 0) fail(unfinished);
  const Descriptor folder(parent.directory(), unfinished.filename(), O_RDONLY | O_DIRECTORY);
  for (const FileContent& file : files)
    Descriptor(folder, file.name, O_WRONLY | O_CREAT | O_EXCL).write_to_disk(file.bytes);
  folder.to_disk();
}

/// The folder's path without a slash at its end. \throw Refusal bad_option
fs::path new_folder(const std::string& folder) {
  fs::path wanted = fs::path(folder).lexically_normal();
  if (!wanted.has_filename()) wanted = wanted.parent_path();  // a slash at the end
  if (!wanted.is_absolute() || !wanted.has_filename())
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "directory '" + folder + "' is not an absolute path");
  std::error_code ignored;  // a path that cannot be looked at cannot be written either, which says why
  const fs::file_type there = fs::symlink_status(wanted, ignored).type();
  if (there != fs::file_type::not_found && there != fs::file_type::none &&
      !(there == fs::file_type::directory && fs::is_empty(wanted, ignored)))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "'" + wanted.string() + "' is there already and is not overwritten");
  return wanted;
}

}  // namespace

bool is_unfinished(const std::string& name) {
  return !name.empty() && name.front() == '.' && fs::path(name).extension() == kUnfinished;
}

void check_new_folder(const std::string& folder) {
  new_folder(folder);
}

std::vector<std::string> write_whole_folder(const std::string& folder,
                                            const std::vector<FileContent>& files) {
  const fs::path wanted = new_folder(folder);
  try {
    fs::create_directories(wanted.parent_path());
    Names names;
    for (const FileContent& file : files) names.insert(file.name);
    const LockedParent parent(parent_of(wanted), names);
    const fs::path unfinished = hidden(parent_of(wanted) / wanted.filename());
    fs::path made = unfinished;
    try {
      write_files(parent, unfinished, files);
      parent.rename(unfinished, wanted);  // fails where a non-empty directory has been created meanwhile
      made = wanted;
      parent.directory().to_disk();
    } catch (const fs::filesystem_error&) {
      try {
        remove_folder(parent.directory(), made);
      } catch (const fs::filesystem_error&) {  // said below is what went wrong first
      }
      throw;
    }
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kCannotWrite,
                            "nothing was written to '" + wanted.string() + "': " + in_words(error));
  }
  std::vector<std::string> paths;
  for (const FileContent& file : files) paths.push_back(wanted / file.name);
  std::sort(paths.begin(), paths.end());
  return paths;
}

void delete_whole_folder(const std::string& folder) {
  try {
    const LockedParent parent(parent_of(folder), names_in(folder));
    const fs::path place = parent_of(folder) / fs::path(folder).filename();
    const fs::file_type there = fs::symlink_status(place).type();
    if (there == fs::file_type::not_found) {
      // An unfinished one, which went with the lock, unless it was finished meanwhile.
      const std::string name = place.filename();
      const std::size_t suffix = sizeof(kUnfinished) - 1;
      if (is_unfinished(name) && fs::exists(place.parent_path() / name.substr(1, name.size() - 1 - suffix))) {
        errno = EBUSY;
        fail(folder);
      }
      return;
    }
    if (there != fs::file_type::directory) {
      errno = ENOTDIR;
      fail(folder);
    }
    parent.rename(place, hidden(place));
    remove_folder(parent.directory(), hidden(place));
    parent.directory().to_disk();
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kCannotWrite,
                            "'" + folder + "' was not deleted: " + in_words(error));
  }
}

void write_whole_file(const std::string& path, const std::string& bytes) {
  const fs::path wanted(path), unfinished(path + kPart);
  try {
    fs::remove(unfinished);  // a link to elsewhere, or what one that was interrupted has left
    try {
      Descriptor(unfinished, O_WRONLY | O_CREAT | O_EXCL).write_to_disk(bytes);
      fs::rename(unfinished, wanted);
    } catch (const fs::filesystem_error&) {
      std::error_code ignored;
      fs::remove(unfinished, ignored);
      throw;
    }
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kCannotWrite, path + " cannot be written: " + in_words(error));
  }
}

std::optional<std::string> bytes_of_plain_file(const std::string& path, std::size_t most) {
  try {
    const Descriptor file(path, O_RDONLY | O_NONBLOCK);  // a pipe would not be opened before it has a writer
    struct stat status {};
    if (fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
        static_cast<std::size_t>(status.st_size) > most)
      return std::nullopt;
    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t done = 0;
    for (ssize_t count = 1; count != 0 && done < bytes.size(); done += static_cast<std::size_t>(count)) {
      count = read(file.number(), bytes.data() + done, bytes.size() - done);
      if (count < 0) return std::nullopt;
    }
    bytes.resize(done);
    return bytes;
  } catch (const fs::filesystem_error&) {
    return std::nullopt;
  }
}

}  // namespace tensegric_fit::files
