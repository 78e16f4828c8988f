#include "files/whole_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

namespace fs = std::filesystem;

constexpr char kUnfinished[] = ".unfinished";  // suffix of hidden folders

[[noreturn]] void fail(const std::string& path) {
  throw fs::filesystem_error("", path, std::error_code(errno, std::generic_category()));
}

std::string in_words(const fs::filesystem_error& error) {
  const std::string path = "'" + error.path1().string() + "'";
  switch (error.code().value()) {
    case ENOSPC:
    case EDQUOT:
      return "the disk of " + path + " is full";
    case EROFS:
    case EACCES:
    case EPERM:
      return path + " is read-only or belongs to someone else";
    case EFBIG:
      return path + " would be larger than files may be";
    default:
      return path + ": " + error.code().message();
  }
}

/// Owns a file descriptor.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : number_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (number_ < 0) fail(path);
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  const int number_;
};

void write_to_disk(const fs::path& path, const std::string& bytes) {
  const Descriptor file(path, O_WRONLY | O_CREAT | O_EXCL);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(file.number(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) fail(path);
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  if (fsync(file.number()) != 0) fail(path);
}

void to_disk(const fs::path& folder) {
  const Descriptor directory(folder, O_RDONLY | O_DIRECTORY);
  if (fsync(directory.number()) != 0) fail(folder);
}

fs::path hidden(const fs::path& folder) {
  return folder.parent_path() / ("." + folder.filename().string() + kUnfinished);
}

/// Held by one writer at a time; unfinished folders that exist when it is acquired were abandoned.
class ParentLock {
 public:
  explicit ParentLock(const fs::path& parent) : directory_(parent, O_RDONLY | O_DIRECTORY) {
    while (flock(directory_.number(), LOCK_EX) != 0)
      if (errno != EINTR) fail(parent);
    for (const fs::directory_entry& entry : fs::directory_iterator(parent)) {
      const std::string name = entry.path().filename().string();
      if (name.front() == '.' && entry.path().extension() == kUnfinished &&
          entry.symlink_status().type() == fs::file_type::directory)
        fs::remove_all(entry.path());
    }
  }

 private:
  const Descriptor directory_;
};

/// The folder's path without a slash at its end. \throw Refusal bad_option
fs::path new_folder(const std::string& folder) {
  fs::path wanted = fs::path(folder).lexically_normal();
  if (!wanted.has_filename()) wanted = wanted.parent_path();  // a slash at the end
  if (!wanted.is_absolute() || !wanted.has_filename())
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "directory '" + folder + "' is not an absolute path");
  std::error_code ignored;  // a path that cannot be looked at cannot be written either, which says why
  if (fs::exists(wanted, ignored) && !(fs::is_directory(wanted, ignored) && fs::is_empty(wanted, ignored)))
    throw geometry::Refusal(geometry::refusal::kBadOption,
                            "'" + wanted.string() + "' is there already and is not overwritten");
  return wanted;
}

}  // namespace

void check_new_folder(const std::string& folder) {
  new_folder(folder);
}

std::vector<std::string> write_whole_folder(const std::string& folder,
                                            const std::vector<FileContent>& files) {
  const fs::path wanted = new_folder(folder);
  const fs::path unfinished = hidden(wanted);
  std::vector<std::string> paths;
  try {
    fs::create_directories(wanted.parent_path());
    const ParentLock lock(wanted.parent_path());
    try {
      fs::create_directory(unfinished);
      for (const FileContent& file : files) {
        write_to_disk(unfinished / file.name, file.bytes);
        paths.push_back(wanted / file.name);
      }
      to_disk(unfinished);
      fs::rename(unfinished, wanted);  // fails where a non-empty directory has been created in the meantime
      to_disk(wanted.parent_path());
    } catch (const fs::filesystem_error&) {
      std::error_code ignored;
      fs::remove_all(unfinished, ignored);
      throw;
    }
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kCannotWrite,
                            "nothing was written to '" + wanted.string() + "': " + in_words(error));
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void delete_whole_folder(const std::string& folder) {
  try {
    const ParentLock lock(fs::path(folder).parent_path());
    const fs::path unfinished = hidden(folder);
    fs::rename(folder, unfinished);
    fs::remove_all(unfinished);
  } catch (const fs::filesystem_error& error) {
    throw geometry::Refusal(geometry::refusal::kCannotWrite,
                            "'" + folder + "' was not deleted: " + in_words(error));
  }
}

}  // namespace tensegric_fit::files
