/// File descriptors. No symbolic link is followed at the end of a path.
#pragma once

#include <filesystem>
#include <string>

namespace tensegric_fit::files {

/// What went wrong with `path`, by errno. \throw std::filesystem::filesystem_error
[[noreturn]] void fail(const std::filesystem::path& path);

/// The same in words, for people.
std::string in_words(const std::filesystem::filesystem_error& error);

/// Owns a file descriptor; files that it creates are their owner's only.
class Descriptor {
 public:
  /// \throw std::filesystem::filesystem_error
  Descriptor(const std::filesystem::path& path, int flags);
  Descriptor(const Descriptor& folder, const std::string& name, int flags);
  ~Descriptor();
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }

  /// All of it, on the disk when this returns. \throw std::filesystem::filesystem_error
  void write_to_disk(const std::string& bytes) const;
  void to_disk() const;

 private:
  const std::filesystem::path path_;
  const int number_;
};

}  // namespace tensegric_fit::files
