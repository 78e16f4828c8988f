/// What the fuzz targets share: an input as a file, and what may come of it.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "geometry/status.hpp"

namespace tensegric_fit::fuzz {

/// The bytes as a file of that ending, in memory; gone with it.
class InputFile {
 public:
  InputFile(const std::uint8_t* data, std::size_t size, const std::string& ending)
      : path_("/dev/shm/tensegric_fit_fuzz_" + std::to_string(getpid()) + ending) {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0) std::abort();
  }
  ~InputFile() { unlink(path_.c_str()); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A refusal by name is right; any other exception ends the process, as a crash does.
inline void refused_or_done(const std::function<void()>& work) {
  try {
    work();
  } catch (const geometry::Refusal& refusal) {
    if (refusal.code().empty() || std::string(refusal.what()).empty()) std::abort();
  }
}

inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace tensegric_fit::fuzz
