#include "stamp.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>

namespace tensegric_fit::regression {
namespace {

// The first line that a command prints; empty where it fails.
std::string first_line_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> output(popen(command.c_str(), "r"), pclose);
  std::array<char, 128> line{};
  if (!output || !std::fgets(line.data(), line.size(), output.get())) return "";
  const std::string text = line.data();
  return text.substr(0, text.find('\n'));
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char letter : text) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + "'";
}

}  // namespace

Stamp stamp_of(const std::string& file) {
  const std::string folder = std::filesystem::absolute(file).parent_path();
  const std::string commit = first_line_of("git -C " + shell_quoted(folder) +
                                           " describe --always --dirty --exclude '*' 2>/dev/null");
  return {fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))), commit.empty() ? "unknown" : commit};
}

}  // namespace tensegric_fit::regression
