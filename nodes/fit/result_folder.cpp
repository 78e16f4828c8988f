#include "fit/result_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include "files/descriptor.hpp"
#include "files/whole_folder.hpp"
#include "fit/result_documents.hpp"

namespace tensegric_fit::fit {

namespace {

namespace fs = std::filesystem;

/// An old result is never taken for a new one. \throw std::filesystem::filesystem_error: one cannot be
/// removed
void remove_old_results(const fs::path& folder, const ResultNames& names) {
  for (const char* name : names) fs::remove(folder / name);
}

/// A part of a result is never taken for the whole.
void remove_results(const fs::path& folder, const ResultNames& names) {
  std::error_code not_there;
  for (const char* name : names) fs::remove(folder / name, not_there);
}

/// The first of the inputs that the results would take the place of, or null.
const std::string* endangered_input(const ProgramRun& run) {
  std::error_code not_there;
  for (const std::string& input : run.inputs)
    for (const char* name : run.names)
      if (fs::equivalent(input, fs::path(run.out) / name, not_there)) return &input;
  return nullptr;
}

/// In a folder that nobody else writes into.
int run_alone(const ProgramRun& run) {
  try {
    remove_old_results(run.out, run.names);
    run.work();
    return 0;
  } catch (const geometry::Refusal& refusal) {
    fmt::print(stderr, "refused: {}: {}\n", refusal.code(), refusal.what());
    remove_results(run.out, run.names);
    try {
      run.refused(refusal);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}\n", run.program, error.what());
    }
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", run.program, error.what());
    remove_results(run.out, run.names);
    return 1;
  }
}

}  // namespace

int run_into_folder(const ProgramRun& run) {
  if (const std::string* input = endangered_input(run)) {
    fmt::print(stderr, "--out: the results would overwrite the input {}\n", *input);
    return 2;
  }
  if (lies_in_export(run.out)) {
    fmt::print(stderr, "--out: {} is an export or lies in one, which takes no other files\n", run.out);
    return 2;
  }
  try {
    fs::create_directories(run.out);
    const files::Descriptor folder(fs::canonical(run.out), O_RDONLY | O_DIRECTORY);
    // Where a file system has no locks it goes on without.
    if (flock(folder.number(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return run_alone(run);
    fmt::print(stderr, "--out: another program writes into this folder: {}\n", run.out);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", run.program, error.what());
  }
  return 1;
}

void say_progress(bool quiet, const std::string& what) {
  if (!quiet && isatty(STDERR_FILENO) != 0) fmt::print(stderr, "{} ...\n", what);
}

void write_text(const std::string& path, const std::string& text) {
  try {
    files::write_whole_file(path, text);
  } catch (const geometry::Refusal& refusal) {  // no input was refused
    throw std::runtime_error(refusal.what());
  }
}

void write_mesh(const std::string& path, const geometry::TriangleMesh& mesh,
                const std::vector<std::array<std::uint8_t, 3>>& colours, geometry::Coordinates coordinates) {
  write_text(path, geometry::ply_bytes(mesh, colours, coordinates));
}

void write_json(const fs::path& path, const nlohmann::ordered_json& json) {
  write_text(path.string(),
             json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace tensegric_fit::fit
