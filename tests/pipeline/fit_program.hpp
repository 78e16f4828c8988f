/// The program `fit` as its users start it: files in, files and an exit code out.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace fs = std::filesystem;

using nlohmann::json;

inline const std::string kScans = TENSEGRIC_FIT_SCANS;

inline const char* const kResults[] = {"report.json",   "body.ply",    "control.ply", "control_deformed.ply",
                                       "deformed.ply",  "history.csv", "front.png",   "side.png",
                                       "distortion.png"};

inline std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class FitProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tensegric_fit_program_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

  // Exit code of a program of this package; -1 where a signal ended it.
  int run(const std::string& words) const {
    const int status = std::system(
        (std::string(TENSEGRIC_FIT_PROGRAMS) + "/" + words + " > " + file("log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int fit(const std::string& arguments, const std::string& out = "out") const {
    return run("fit " + arguments + " --quiet --out " + file(out));
  }
  std::string log() const { return read_file(file("log")); }
  json report(const std::string& out = "out") const {
    return json::parse(read_file(folder_ / out / "report.json"));
  }

  void expect_refused(const std::string& arguments, const std::string& code) const {
    EXPECT_EQ(fit(arguments), 3) << read_file(file("log"));
    const json said = report();
    EXPECT_EQ(said["status"], "refused");
    EXPECT_EQ(said["reason"]["code"], code) << said["reason"]["message"];
    EXPECT_FALSE(said["reason"]["message"].get<std::string>().empty());
    for (const char* name : kResults)
      EXPECT_EQ(fs::exists(folder_ / "out" / name), std::string(name) == "report.json") << name;
  }

  fs::path folder_;
};
