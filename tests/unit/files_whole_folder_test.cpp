/// Folders that are there whole or not at all, whatever happens to the process that writes them.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "files/owner_only.hpp"
#include "files/whole_folder.hpp"
#include "geometry/status.hpp"
#include "stopped_child.hpp"

namespace tensegric_fit::files {
namespace {

namespace fs = std::filesystem;

class WholeFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    fs::create_directories(root_);
    for (int i = 0; i < 8; ++i) files_.push_back({"file" + std::to_string(i), std::string(1 << 16, 'x')});
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

  void try_to_write(const fs::path& folder) const {
    try {
      write_whole_folder(folder, files_);
    } catch (const geometry::Refusal&) {
    }
  }
  static void try_to_write_file(const fs::path& file) {
    try {
      write_whole_file(file, std::string(1 << 20, 'x'));
    } catch (const geometry::Refusal&) {
    }
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

TEST_F(WholeFolderTest, StoppedAtAnySystemCallItLeavesNothingOrTheWhole) {
  for (const Stop stop : {Stop::kKill, Stop::kNoSpace}) {
    int calls = 0, interrupted = 0;
    const auto folder = [&] { return root_ / std::to_string(calls); };
    for (; stopped_at(calls, stop, [&] { try_to_write(folder()); }); ++calls) {
      if (fs::exists(folder()))
        expect_whole(folder());
      else
        ++interrupted;
      fs::remove_all(folder());
    }
    EXPECT_GT(interrupted, 10) << "of " << calls << " calls";
    expect_whole(folder());  // by the one that was stopped nowhere
    EXPECT_EQ(names(), std::set<std::string>{folder().filename()}) << "remains of an interrupted one";
    fs::remove_all(folder());
  }
}

TEST_F(WholeFolderTest, StoppedAtAnySystemCallAFileIsTheOldOrTheNew) {
  for (const Stop stop : {Stop::kKill, Stop::kNoSpace}) {
    const fs::path file = root_ / "file";
    int calls = 0;
    std::set<std::size_t> sizes;
    do {
      std::ofstream(file) << "old";
      sizes.insert(fs::file_size(file));
    } while (stopped_at(calls++, stop, [&] { try_to_write_file(file); }));
    sizes.insert(fs::file_size(file));
    EXPECT_EQ(sizes, (std::set<std::size_t>{3, 1 << 20})) << "after " << calls << " calls";
  }
}

TEST_F(WholeFolderTest, WhatIsWrittenIsItsOwnersOnly) {
  const mode_t before = umask(0);
  write_whole_folder(root_ / "fit", files_);
  write_whole_file(root_ / "file", "bytes");
  EXPECT_EQ(fs::status(root_ / "fit").permissions(), fs::perms::owner_all);
  constexpr auto kOwners = fs::perms::owner_read | fs::perms::owner_write;
  EXPECT_EQ(fs::status(root_ / "fit" / "file0").permissions(), kOwners);
  EXPECT_EQ(fs::status(root_ / "file").permissions(), kOwners);
  owner_only();  // for what is written by others' means
  std::ofstream(root_ / "other") << "bytes";
  fs::create_directories(root_ / "a" / "b");
  EXPECT_EQ(fs::status(root_ / "other").permissions(), kOwners);
  EXPECT_EQ(fs::status(root_ / "a").permissions(), fs::perms::owner_all);
  umask(before);
}

TEST_F(WholeFolderTest, LinksAreNotFollowed) {
  const fs::path precious = root_ / "precious";
  fs::create_directories(precious);
  std::ofstream(precious / "file0") << "mine";
  const auto is_untouched = [&] {
    return std::distance(fs::directory_iterator(precious), {}) == 1 && fs::file_size(precious / "file0") == 4;
  };
  // where the unfinished folder, the folder itself or a file is to be written
  fs::create_directory_symlink(precious, root_ / ".fit.unfinished");
  EXPECT_THROW(write_whole_folder(root_ / "fit", files_), geometry::Refusal);
  EXPECT_TRUE(is_untouched());
  fs::create_directories(root_ / "nothing_in_it");
  fs::create_directory_symlink(root_ / "nothing_in_it", root_ / "link");
  EXPECT_THROW(write_whole_folder(root_ / "link", files_), geometry::Refusal);
  EXPECT_TRUE(fs::is_empty(root_ / "nothing_in_it"));
  fs::create_symlink(precious / "file0", root_ / "file.part");
  fs::create_symlink(precious / "file0", root_ / "file");
  write_whole_file(root_ / "file", "bytes");
  EXPECT_TRUE(is_untouched());
  EXPECT_EQ(fs::symlink_status(root_ / "file").type(), fs::file_type::regular);

  // where it is deleted
  write_whole_folder(root_ / "with_links", files_);
  fs::create_directory_symlink(precious, root_ / "with_links" / "folder");
  fs::create_symlink(precious / "file0", root_ / "with_links" / "file");
  delete_whole_folder(root_ / "with_links");
  EXPECT_FALSE(fs::exists(root_ / "with_links"));
  EXPECT_TRUE(is_untouched());
  fs::create_directory_symlink(precious, root_ / "fit");
  EXPECT_THROW(delete_whole_folder(root_ / "fit"), geometry::Refusal);
  EXPECT_TRUE(is_untouched());
}

TEST_F(WholeFolderTest, AFileThatCannotBeWrittenToItsEndLeavesNothing) {
  const std::string words = refused_in_child([] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 15, 1 << 15};
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

TEST_F(WholeFolderTest, WhatCannotBeTidiedUpHindersItsOwnNameAlone) {
  fs::create_directories(root_ / ".other.unfinished" / "sub");
  write_whole_folder(root_ / "fit", files_);
  expect_whole(root_ / "fit");
  EXPECT_THROW(write_whole_folder(root_ / "other", files_), geometry::Refusal);
  delete_whole_folder(root_ / "fit");
  EXPECT_TRUE(fs::exists(root_ / ".other.unfinished" / "sub"));
}

TEST_F(WholeFolderTest, ADeletedFolderIsGone) {
  write_whole_folder(root_ / "fit", files_);
  delete_whole_folder(root_ / "fit");
  EXPECT_TRUE(names().empty());
  EXPECT_NO_THROW(
      delete_whole_folder(root_ / "fit"));  // an unfinished one goes as soon as the folder is locked
}

}  // namespace
}  // namespace tensegric_fit::files
