#include "files/descriptor.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tensegric_fit::files {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kOwners = S_IRUSR | S_IWUSR;

int opened(int folder, const std::string& name, int flags, const fs::path& path) {
  const int number = openat(folder, name.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, kOwners);
  if (number < 0) fail(path);
  return number;
}

}  // namespace

void fail(const fs::path& path) {
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
    case ELOOP:
      return path + " is a link";
    case EWOULDBLOCK:
      return "another program writes to " + path + " and does not end";
    default:
      return path + ": " + error.code().message();
  }
}

Descriptor::Descriptor(const fs::path& path, int flags)
    : path_(path), number_(opened(AT_FDCWD, path.string(), flags, path_)) {}

Descriptor::Descriptor(const Descriptor& folder, const std::string& name, int flags)
    : path_(folder.path_ / name), number_(opened(folder.number_, name, flags, path_)) {}

Descriptor::~Descriptor() {
  close(number_);
}

void Descriptor::write_to_disk(const std::string& bytes) const {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(number_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) fail(path_);
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  to_disk();
}

void Descriptor::to_disk() const {
  if (fsync(number_) != 0) fail(path_);
}

}  // namespace tensegric_fit::files
