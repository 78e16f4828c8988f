/// A folder that is watched for scans. The clock is the test's own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "geometry/status.hpp"
#include "scan_files/scan_folder.hpp"

namespace tensegric_fit::scan_files {
namespace {

namespace fs = std::filesystem;

class ScanFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(root_ / name) << text;
    fs::last_write_time(root_ / name, fs::file_time_type(std::chrono::seconds(++written_)));
  }

  /// Names of the files that are complete now, with spaces between them.
  static std::string played(ScanFolder& folder, double now) {
    std::string names;
    for (const std::string& path : folder.poll(now))
      names += (names.empty() ? "" : " ") + fs::path(path).filename().string();
    return names;
  }

  const fs::path root_ = fs::temp_directory_path() / "tensegric_fit_scan_folder_test";
  int written_ = 0;
};

TEST_F(ScanFolderTest, AFileIsPlayedOnceAndOnlyWhenItIsStill) {
  ScanFolder folder(root_, 1);
  EXPECT_EQ(played(folder, 0), "");
  write("a.ply", "half");
  EXPECT_EQ(played(folder, 0.5), "");
  EXPECT_EQ(played(folder, 1.4), "");  // still for less than a second
  write("a.ply", "half and half");
  EXPECT_EQ(played(folder, 1.6), "");
  EXPECT_EQ(played(folder, 2.5), "");
  EXPECT_EQ(played(folder, 2.6), "a.ply");
  EXPECT_EQ(played(folder, 10), "");
}

TEST_F(ScanFolderTest, WhatWasThereBeforeIsOldAndNewOnesComeInTheirOrder) {
  write("old.ply", "old");
  ScanFolder folder(root_, 1);
  folder.skip_all();
  write("b.PCD", "first");
  write("a.bag", "second");
  EXPECT_EQ(played(folder, 0), "");
  EXPECT_EQ(played(folder, 1), "b.PCD a.bag");
}

TEST_F(ScanFolderTest, RenamedInIsNewAndWrittenAgainIsNew) {
  ScanFolder folder(root_, 1);
  write("a.part", "whole");
  EXPECT_EQ(played(folder, 0), "");
  fs::rename(root_ / "a.part", root_ / "a.ply");
  EXPECT_EQ(played(folder, 1), "");
  EXPECT_EQ(played(folder, 2), "a.ply");
  write("a.ply", "other");  // a booth that has one name for all
  EXPECT_EQ(played(folder, 3), "");
  EXPECT_EQ(played(folder, 4), "a.ply");
}

// A thousand customers of before would be played one by one.
TEST_F(ScanFolderTest, AShareThatWasAwayForAMomentPlaysNothingAgain) {
  write("old.ply", "old");
  ScanFolder folder(root_, 1);
  folder.skip_all();
  write("a.ply", "a");
  played(folder, 0);
  EXPECT_EQ(played(folder, 1), "a.ply");
  const fs::path away = root_.string() + "_away";
  fs::rename(root_, away);
  fs::create_directories(root_);
  EXPECT_EQ(played(folder, 2), "");
  fs::remove(root_);
  fs::rename(away, root_);
  EXPECT_EQ(played(folder, 3), "");
  EXPECT_EQ(played(folder, 9), "");

  fs::rename(root_, away);  // and is away when the player is started again
  fs::create_directories(root_);
  ScanFolder next(root_, 1);
  next.skip(folder.played());
  EXPECT_EQ(played(next, 10), "");
  fs::remove(root_);
  fs::rename(away, root_);
  EXPECT_EQ(played(next, 11), "");
  EXPECT_EQ(played(next, 19), "");
}

TEST_F(ScanFolderTest, TextsThatStandForNoFileArePassedOver) {
  write("a.ply", "a");
  ScanFolder folder(root_, 0);
  folder.skip({"", "a.ply", "1 a.ply", "x y a.ply"});
  EXPECT_EQ(played(folder, 0), "a.ply");
}

// The master takes no other text for a parameter, and forgot all files after such a one.
TEST_F(ScanFolderTest, AnyNameIsPlainTextAndComesBack) {
  for (const std::string name : {"M\xfcller 50%41.ply", "a\tb.ply", "100%.ply", "%zz.ply", "a b.ply"}) {
    write(name, name);
    ScanFolder folder(root_, 0);
    played(folder, 0);
    const std::string text = folder.text(name);
    for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << text;
    EXPECT_EQ(ScanFolder::name_in(text), name);
    ScanFolder next(root_, 0);
    next.skip(folder.played());
    EXPECT_EQ(played(next, 0), "") << text;
  }
}

TEST_F(ScanFolderTest, OtherFilesAreNamedAndWhatIsHiddenOrNoFileIsNot) {
  ScanFolder folder(root_, 1);
  for (const char* name : {".hidden.ply", "readme.txt", "ply", "a.ply.part"}) write(name, "text");
  fs::create_directories(root_ / "folder.ply");
  fs::create_symlink(root_ / "nowhere", root_ / "dangling.ply");
  played(folder, 0);
  EXPECT_EQ(played(folder, 5), "readme.txt ply a.ply.part");
}

TEST_F(ScanFolderTest, AnotherLifeGoesOnWhereTheFirstEnded) {
  write("a.ply", "a");
  ScanFolder first(root_, 1);
  played(first, 0);
  EXPECT_EQ(played(first, 1), "a.ply");
  write("b.ply", "while nobody watched");
  write("c.ply", "c");
  ScanFolder second(root_, 1);
  second.skip(first.played());
  EXPECT_EQ(second.played().size(), 1u);
  played(second, 0);
  EXPECT_EQ(played(second, 1), "b.ply c.ply");
  fs::remove(root_ / "a.ply");
  played(second, 2);
  EXPECT_EQ(second.played().size(), 2u);  // what is gone need not be remembered
}

TEST_F(ScanFolderTest, AFileThatStillWaitsIsForTheNextLife) {
  write("a.ply", "a");
  write("b.ply", "b");
  ScanFolder first(root_, 1);
  played(first, 0);
  EXPECT_EQ(played(first, 1), "a.ply b.ply");
  ScanFolder second(root_, 1);
  second.skip(first.played({"b.ply"}));
  played(second, 0);
  EXPECT_EQ(played(second, 1), "b.ply");
}

// What the player says of the file that it is at: another version of it is another file.
TEST_F(ScanFolderTest, ATextHasTheNameAndTheVersion) {
  const std::string name = "1 2 of Mrs. Example.ply";
  ScanFolder folder(root_, 1);
  write(name, "scan");
  EXPECT_EQ(played(folder, 0), "");
  EXPECT_EQ(played(folder, 1), name);
  const std::string text = folder.text(name);
  EXPECT_EQ(folder.played(), std::vector{text});
  EXPECT_EQ(ScanFolder::name_in(text), name);
  write(name, "scan");
  EXPECT_EQ(played(folder, 2), "");
  EXPECT_EQ(played(folder, 3), name);
  EXPECT_NE(folder.text(name), text);
}

TEST_F(ScanFolderTest, AFolderThatIsGoneIsSaidAndMayComeBack) {
  ScanFolder folder(root_, 1);
  fs::remove_all(root_);
  EXPECT_THROW(folder.poll(0), geometry::Refusal);
  fs::create_directories(root_);
  write("a.ply", "a");
  played(folder, 1);
  EXPECT_EQ(played(folder, 2), "a.ply");
}

}  // namespace
}  // namespace tensegric_fit::scan_files
