#include "ros/sealed.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <numeric>
#include <regex>

#include "geometry/spawned_process.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::node {
namespace {

using geometry::Refusal;

constexpr char kAge[] = "/usr/bin/age";
constexpr std::size_t kBlock = 512;  // bytes of a tar block (POSIX.1-1988 ustar)

std::string padded(std::string bytes, std::size_t size) {
  bytes.resize((bytes.size() + size - 1) / size * size);
  return bytes;
}

std::string header_of(const files::FileContent& file) {
  std::string header = file.name;
  header.resize(100);  // offsets of the fields: name 0, mode 100, ..., checksum 148, type 156, magic 257
  header +=
      fmt::format("{:07o}", 0600) + '\0' + fmt::format("{:07o}", 0) + '\0' + fmt::format("{:07o}", 0) + '\0';
  header += fmt::format("{:011o}", file.bytes.size()) + '\0' + fmt::format("{:011o}", 0) + '\0';
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
  std::string archive;
  for (const files::FileContent& file : files) archive += header_of(file) + padded(file.bytes, kBlock);
  return archive + std::string(2 * kBlock, '\0');
}

/// Writes and reads in turn: a filter stops reading while nobody takes what it wrote.
std::string through(int channel, const std::string& bytes) {
  std::string result;
  std::array<char, 65536> part{};
  for (std::size_t done = 0;;) {
    const bool writing = done < bytes.size();
    pollfd ready{channel, static_cast<short>(writing ? POLLIN | POLLOUT : POLLIN), 0};
    if (poll(&ready, 1, -1) < 0 && errno != EINTR) return result;
    if (writing && (ready.revents & POLLOUT) != 0) {
      const ssize_t count =
          send(channel, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count < 0 && errno != EAGAIN && errno != EINTR) return result;
      if (count > 0) done += static_cast<std::size_t>(count);
      if (done == bytes.size()) shutdown(channel, SHUT_WR);
    }
    if ((ready.revents & (POLLIN | POLLHUP)) == 0) continue;
    const ssize_t count = recv(channel, part.data(), part.size(), MSG_DONTWAIT);
    if (count == 0) return result;
    if (count < 0 && errno != EAGAIN && errno != EINTR) return result;
    if (count > 0) result.append(part.data(), static_cast<std::size_t>(count));
  }
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

std::string sealed(const std::vector<files::FileContent>& files, const std::string& recipient) {
  const auto failed = [](const std::string& why) {
    return Refusal(geometry::refusal::kCannotWrite,
                   "nothing was written, as it was not encrypted: age " + why);
  };
  geometry::SpawnedProcess age;
  try {
    age = geometry::spawn(kAge, {"--encrypt", "--recipient", recipient});
  } catch (const std::runtime_error& error) {
    throw failed(error.what());
  }
  std::string bytes = through(age.channel, tar_of(files));
  close(age.channel);
  const int status = geometry::wait_for(age.id);
  if (status != 0) throw failed(geometry::ending(status));
  return bytes;
}

}  // namespace tensegric_fit::node
