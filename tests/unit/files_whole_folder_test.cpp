/// Folders that are there whole or not at all, whatever happens to the process that writes them.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "files/whole_folder.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::files {
namespace {

namespace fs = std::filesystem;

class WholeFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    fs::create_directories(root_);
    for (int i = 0; i < 8; ++i) files_.push_back({"file" + std::to_string(i), std::string(1 << 20, 'x')});
  }
  void TearDown() override { fs::remove_all(root_); }

  std::set<std::string> names() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(root_))
      names.insert(entry.path().filename());
    return names;
  }

  void expect_whole(const fs::path& folder) const {
    for (const FileContent& file : files_)
      EXPECT_EQ(fs::file_size(folder / file.name), file.bytes.size()) << file.name;
  }

  /// Code and words of the refusal in a process of its own; empty where there was none.
  std::string refused_in_child(const std::function<void()>& before) const {
    const fs::path said = fs::temp_directory_path() / "tensegric_fit_whole_folder_said";
    std::ofstream open_for_child(said);
    const pid_t child = fork();
    if (child == 0) {
      try {
        before();
        write_whole_folder(root_ / "fit", files_);
      } catch (const geometry::Refusal& refusal) {
        open_for_child << refusal.code() << ": " << refusal.what() << std::flush;
      }
      _exit(0);
    }
    waitpid(child, nullptr, 0);
    std::ifstream file(said);
    std::string words;
    std::getline(file, words);
    fs::remove(said);
    return words;
  }

  const fs::path root_ = fs::temp_directory_path() / "tensegric_fit_whole_folder_test";
  std::vector<FileContent> files_;
};

TEST_F(WholeFolderTest, KilledAtAnyPointItLeavesNothingOrTheWhole) {
  const auto start = std::chrono::steady_clock::now();
  write_whole_folder(root_ / "first", files_);
  const auto took =
      std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
  constexpr int kKills = 40;
  int interrupted = 0;
  for (int i = 0; i < kKills; ++i) {
    const fs::path folder = root_ / std::to_string(i);
    const pid_t child = fork();
    if (child == 0) {
      write_whole_folder(folder, files_);
      _exit(0);
    }
    usleep(static_cast<useconds_t>(took.count() * i / kKills));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (fs::exists(folder))
      expect_whole(folder);
    else
      ++interrupted;
  }
  EXPECT_GT(interrupted, 0) << "no kill came in time: nothing was tested";
  write_whole_folder(root_ / "last", files_);
  for (const std::string& name : names()) EXPECT_NE(name.front(), '.') << "remains of an interrupted one";
}

TEST_F(WholeFolderTest, AFileThatCannotBeWrittenToItsEndLeavesNothing) {
  const std::string words = refused_in_child([] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 19, 1 << 19};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  EXPECT_EQ(words.rfind("cannot_write: nothing was written to '", 0), 0u) << words;
  EXPECT_NE(words.find("would be larger than files may be"), std::string::npos) << words;
  EXPECT_TRUE(names().empty());
}

TEST_F(WholeFolderTest, AReadOnlyFolderIsRefusedInWords) {
  fs::permissions(
      root_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  const std::string words = refused_in_child([] {
    if (geteuid() == 0 && setuid(65534) != 0) _exit(1);  // root may write anywhere
  });
  fs::permissions(root_, fs::perms::owner_all);
  EXPECT_EQ(words.rfind("cannot_write: nothing was written to '", 0), 0u) << words;
  EXPECT_NE(words.find("is read-only or belongs to someone else"), std::string::npos) << words;
  EXPECT_TRUE(names().empty());
}

TEST_F(WholeFolderTest, WhatIsThereIsNotOverwritten) {
  const auto code_of = [&](const fs::path& folder) -> std::string {
    try {
      write_whole_folder(folder, files_);
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "";
  };
  fs::create_directories(root_ / "filled");
  std::ofstream(root_ / "filled" / "precious") << "mine";
  std::ofstream(root_ / "empty_file");
  fs::create_directories(root_ / "empty");
  EXPECT_EQ(code_of(root_ / "filled"), "bad_option");
  EXPECT_EQ(code_of(root_ / "empty_file"), "bad_option");
  EXPECT_EQ(code_of("relative/path"), "bad_option");
  EXPECT_EQ(code_of(""), "bad_option");
  EXPECT_EQ(code_of("/"), "bad_option");
  EXPECT_EQ(code_of(root_ / "empty_file" / "below"), "cannot_write");
  EXPECT_EQ(code_of(root_ / std::string(300, 'x')), "cannot_write");  // a longer name than folders have
  EXPECT_EQ(code_of((root_ / "empty").string() + "/"), "");
  expect_whole(root_ / "empty");
  EXPECT_EQ(names(), (std::set<std::string>{"filled", "empty_file", "empty"}));
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "filled"), {}), 1);
}

TEST_F(WholeFolderTest, ADeletedFolderIsGone) {
  write_whole_folder(root_ / "fit", files_);
  delete_whole_folder(root_ / "fit");
  EXPECT_TRUE(names().empty());
  EXPECT_THROW(delete_whole_folder(root_ / "fit"), geometry::Refusal);
}

}  // namespace
}  // namespace tensegric_fit::files
