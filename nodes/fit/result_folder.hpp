/// The folder that a program writes its results into.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/ply.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::fit {

/// Names of the files that a program writes.
using ResultNames = std::vector<const char*>;

/// Of `correlate`. They are of the body that was there then: a new `fit` into the same folder removes them.
inline constexpr const char* kCorrelateFiles[] = {"correlate.json", "correlate.html", "distance.png",
                                                  "distance.ply",   "distance.csv",   "silhouettes.png"};

/// What a program that writes its results into a folder does, and its exit code: 0 done; 1 something cannot
/// be written, and nothing is left, or another program writes into the folder, which is left alone; 2 an
/// input (a path, or empty) or an export would be overwritten; 3 the input is refused, and what `refused`
/// writes is left alone. What is wrong goes to stderr.
struct ProgramRun {
  const char* program;
  std::string out;
  ResultNames names;
  std::vector<std::string> inputs;
  std::function<void()> work;
  std::function<void(const geometry::Refusal&)> refused;
};
int run_into_folder(const ProgramRun& run);

/// Says on a terminal what is being done, unless `quiet`.
void say_progress(bool quiet, const std::string& what);

/// Writes a whole file or none. \throw std::runtime_error where it cannot be written
void write_text(const std::string& path, const std::string& text);

/// The same of a PLY as geometry::ply_bytes makes it.
void write_mesh(const std::string& path, const geometry::TriangleMesh& mesh,
                const std::vector<std::array<std::uint8_t, 3>>& colours = {},
                geometry::Coordinates coordinates = geometry::Coordinates::float32);

/// The same. Names in files may hold any bytes; a report is UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace tensegric_fit::fit
