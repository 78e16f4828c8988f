#include "batch/identity.hpp"

#include <fmt/format.h>
#include <link.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "geometry/shipped_files.hpp"
#include "geometry/spawned_process.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSubjectDigits = 32, kBuildDigits = 16, kManifestDigits = 16;

/// SHA-256 of texts and files, each after its length, so that no two lists of them read alike.
class Digest {
 public:
  Digest() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  void text(const std::string& value) {
    number(value.size());
    EVP_DigestUpdate(context_.get(), value.data(), value.size());
  }

  void file(const fs::path& path) {
    std::error_code unreadable;  // so is all but a regular file: a pipe opens when somebody writes to it
    number(fs::file_size(path, unreadable));
    std::ifstream stream;
    if (!unreadable) stream.open(path, std::ios::binary);
    if (!stream.is_open())
      throw geometry::Refusal(geometry::refusal::kBrokenFile, path.string() + " cannot be read");
    std::vector<char> block(std::size_t{1} << 20);
    while (stream.read(block.data(), static_cast<std::streamsize>(block.size())), stream.gcount() > 0)
      EVP_DigestUpdate(context_.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
  }

  /// Names and content, in the order of the names.
  void folder(const fs::path& path) {
    std::vector<fs::path> files;
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator(path, missing))
      if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& one : files) {
      text(one.filename());
      file(one);
    }
  }

  std::string hex(std::size_t digits) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    EVP_DigestFinal_ex(context_.get(), bytes.data(), nullptr);
    return fmt::format("{:02x}", fmt::join(bytes, "")).substr(0, digits);
  }

 private:
  void number(std::size_t value) { EVP_DigestUpdate(context_.get(), &value, sizeof(value)); }

  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

/// Paths of this project's libraries that are loaded.
int collect(dl_phdr_info* info, std::size_t, void* paths) {
  if (std::string(info->dlpi_name).find("/libtensegric_fit_") != std::string::npos)
    static_cast<std::vector<fs::path>*>(paths)->emplace_back(info->dlpi_name);
  return 0;
}

std::string build_of_this_program() {
  std::vector<fs::path> files{geometry::sibling_program("fit_batch"),
                              geometry::sibling_program("poisson_worker")};
  dl_iterate_phdr(collect, &files);
  std::sort(files.begin() + 2, files.end(),
            [](const fs::path& a, const fs::path& b) { return a.filename() < b.filename(); });
  Digest digest;
  for (const fs::path& file : files) digest.file(file);
  for (const char* folder : {"body_model", "garments", "templates", "tissue"})
    digest.folder(geometry::shipped_folder(folder));
  return digest.hex(kBuildDigits);
}

}  // namespace

const std::string& build_identity() {
  static const std::string build = build_of_this_program();
  return build;
}

std::string manifest_identity(const std::vector<Job>& jobs, const std::string& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  Digest digest;
  for (const Job& job : jobs) {
    digest.text(job.name);
    for (const auto& [name, values] : job.options) {
      digest.text(name);
      for (const std::string& part : name == "garment" ? geometry::joined_words(values.at(0)) : values)
        digest.text(fs::path(part).is_absolute() ? fs::path(part).lexically_relative(folder).string() : part);
    }
  }
  return digest.hex(kManifestDigits);
}

Identity identity_of(const Job& job, const std::string& build) {
  Digest digest;
  for (const auto& [name, values] : job.options) {
    digest.text(name);
    for (const std::string& value : name == "garment" ? geometry::joined_words(values.at(0)) : values) {
      // A file counts by its content, wherever it lies.
      std::error_code error;
      if (name == "scan" || name == "mesh" || name == "tissue" ||
          (fs::path(value).is_absolute() && fs::is_regular_file(value, error))) {
        digest.file(value);
      } else if (name == "templates") {
        digest.folder(value);
      } else {
        digest.text(value);
      }
    }
  }
  Identity identity{digest.hex(kSubjectDigits), {}};
  Digest both;
  both.text(identity.subject);
  both.text(build);
  identity.key = both.hex(kSubjectDigits);
  return identity;
}

}  // namespace tensegric_fit::batch
