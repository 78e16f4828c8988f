#include "ros/sealed.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <numeric>
#include <regex>

#include "geometry/child_process.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;

constexpr std::size_t kBlock = 512;  // bytes of a tar block (POSIX.1-1988 ustar)

std::string padded(std::string bytes, std::size_t size) {
  bytes.resize((bytes.size() + size - 1) / size * size);
  return bytes;
}

std::string header_of(const files::FileContent& file, std::time_t written) {
  std::string header = file.name;
  header.resize(100);  // offsets of the fields: name 0, mode 100, ..., checksum 148, type 156, magic 257
  header +=
      fmt::format("{:07o}", 0600) + '\0' + fmt::format("{:07o}", 0) + '\0' + fmt::format("{:07o}", 0) + '\0';
  header += fmt::format("{:011o}", file.bytes.size()) + '\0' + fmt::format("{:011o}", written) + '\0';
  header += std::string(8, ' ') + '0';
  header.resize(257);
  header += std::string(
      "ustar\0"
      "00",
      8);
  header = padded(header, kBlock);
  const unsigned sum = std::accumulate(header.begin(), header.end(), 0U, [](unsigned total, char byte) {
    return total + static_cast<unsigned char>(byte);
  });
  return header.replace(148, 7, fmt::format("{:06o}", sum) + '\0');
}

std::string tar_of(const std::vector<files::FileContent>& files) {
  const std::time_t now = std::time(nullptr);  // retention goes by the age of what is unpacked

  std::string archive;
  for (const files::FileContent& file : files) archive += header_of(file, now) + padded(file.bytes, kBlock);
  return archive + std::string(2 * kBlock, '\0');
}

}  // namespace

void check_recipient(const std::string& recipient) {
  static const std::regex key("age1[a-z0-9]{58}|ssh-(ed25519|rsa) [A-Za-z0-9+/=]+( [^\n]*)?");
  if (!std::regex_match(recipient, key))
    throw Refusal(geometry::refusal::kBadOption,
                  "parameter 'age_recipient': no public key as age-keygen writes it (age1...)");
  if (access(kAge, X_OK) != 0)
    throw Refusal(
        geometry::refusal::kBadOption,
        fmt::format("parameter 'age_recipient': there is no {}; Debian's package age has it", kAge));
}

std::string sealed(const std::vector<files::FileContent>& files, const std::string& recipient,
                   const std::string& program, double seconds) {
  try {
    geometry::ChildProcess age(program, {"--encrypt", "--recipient", recipient});
    return age.answer(tar_of(files), seconds);
  } catch (const geometry::ChildFailure& failure) {
    throw Refusal(geometry::refusal::kCannotWrite,
                  std::string("nothing was written, as it was not encrypted: age ") + failure.what());
  }
}

}  // namespace tensegric_fit::node
