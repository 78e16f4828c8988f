/// Folders of exports: encrypted, old, made to harm, deleted.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "ros/sealed.hpp"
#include "ros_exported_scan.hpp"

namespace tensegric_fit::node {
namespace {

class ExportFolders : public ExportFitTest {};

TEST_F(ExportFolders, AnEncryptedExportIsReadWithItsKeyAlone) {
  if (std::system("command -v age-keygen > /dev/null") != 0) GTEST_SKIP() << "age is not installed";
  fs::create_directories(root_);
  const std::string key = (root_ / "key").string(), out = (root_ / "out").string();
  ASSERT_EQ(
      std::system(
          ("age-keygen -o " + key + " 2> /dev/null && age-keygen -y " + key + " > " + key + ".pub").c_str()),
      0);
  std::string recipient = text_of(key + ".pub");
  recipient.pop_back();  // end of the line
  EXPECT_NO_THROW(check_recipient(recipient));
  for (const std::string& bad : {std::string("age1short"), "-o/etc/passwd" + recipient, recipient + "\n"})
    EXPECT_THROW(check_recipient(bad), geometry::Refusal) << bad;

  const fs::path folder = root_ / "exports" / "one";
  EXPECT_EQ(export_fit(scan_, folder, {true, recipient}).size(), 2u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2) << "nothing else";
  EXPECT_EQ(nlohmann::json::parse(text_of(folder / "sealed.json")).size(), 3u);
  fs::create_directories(out);
  ASSERT_EQ(
      std::system(
          ("age -d -i " + key + " " + (folder / "fit.tar.age").string() + " | tar -x -C " + out).c_str()),
      0);
  export_fit(scan_, root_ / "plain", kWhole);
  for (const auto& entry : fs::directory_iterator(root_ / "plain"))
    EXPECT_EQ(text_of(entry.path()), text_of(fs::path(out) / entry.path().filename())) << entry.path();
  std::vector<std::string> not_deleted;
  EXPECT_TRUE(delete_old_exports(root_, 1, not_deleted).empty()) << "what was unpacked is not old";
  std::vector<geometry::Refusal> left;
  EXPECT_EQ(delete_exports(root_ / "exports", scan_.body->scan_id, left).exports,
            std::vector<std::string>{folder});
}

TEST_F(ExportFolders, AnAgeThatHangsOrFailsIsRefused) {
  fs::create_directories(root_);
  const std::string age = (root_ / "age").string();
  const std::vector<files::FileContent> contents{{"fit.json", std::string(1 << 20, 'x')}};
  const auto refused = [&](const char* script) -> std::string {
    std::ofstream(age) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(age, fs::perms::owner_all);
    try {
      sealed(contents, "age1", age, 0.3);
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kCannotWrite);
      return refusal.what();
    }
    return "";
  };
  const std::string unsealed = "nothing was written, as it was not encrypted: age ";
  EXPECT_EQ(refused("exec sleep 20"), unsealed + "was not ready after 0.3 s");
  EXPECT_EQ(refused("exec <&- >&-; exec sleep 20"), unsealed + "did not end within 0.3 s");
  EXPECT_EQ(refused("exit 3"), unsealed + "ended with exit code 3");
}

TEST_F(ExportFolders, WhatADeletionThatWasCutOffHasLeftGoesToo) {
  const fs::path rest = root_ / "deep" / ".cut_off.unfinished",
                 other = root_ / "deep" / ".not_ours.unfinished";
  for (const bool retention : {false, true}) {
    export_fit(scan_, root_ / "deep" / "whole", kWhole);
    for (const fs::path& folder : {rest, other}) {
      fs::create_directories(folder);
      std::ofstream(folder / "body.ply") << "of a customer";  // and no document, by which exports are known
    }
    std::ofstream(other / "precious") << "mine";
    std::vector<geometry::Refusal> left;
    std::vector<std::string> not_deleted;
    if (retention) {
      EXPECT_EQ(delete_old_exports(root_, 1, not_deleted), std::vector<std::string>{rest});
    } else {
      const DeletedExports gone = delete_exports(root_, scan_.body->scan_id, left);
      EXPECT_EQ(gone.rests, std::vector<std::string>{rest}) << "nobody knows whose it is";
      EXPECT_EQ(gone.exports.size(), 1u) << "the whole one of that scan";
    }
    EXPECT_FALSE(fs::exists(rest));
    EXPECT_TRUE(fs::exists(other / "precious"));
    EXPECT_TRUE(left.empty() && not_deleted.empty());
    fs::remove_all(root_);
  }
}

TEST_F(ExportFolders, OldExportsGoAndNothingElse) {
  for (const char* name : {"old", "new", "spoilt"}) export_fit(scan_, root_ / name, kWhole);
  std::ofstream(root_ / "spoilt" / "precious") << "mine";
  fs::create_directories(root_ / "no_export");
  fs::create_directory_symlink(root_ / "new", root_ / "link");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24 * 31);
  for (const char* name : {"old", "spoilt"}) fs::last_write_time(root_ / name / "fit.json", long_ago);
  std::vector<std::string> left;
  EXPECT_TRUE(delete_old_exports(root_, 32, left).empty());
  EXPECT_TRUE(left.empty());
  EXPECT_EQ(delete_old_exports(root_, 30, left), std::vector<std::string>{root_ / "old"});
  EXPECT_EQ(left.size(), 1u) << "the spoilt one";
  for (const char* name : {"new", "spoilt", "no_export"}) EXPECT_TRUE(fs::exists(root_ / name)) << name;
  left.clear();
  EXPECT_TRUE(delete_old_exports(root_ / "nowhere", 30, left).empty());
  EXPECT_EQ(left.size(), 1u);
}

TEST_F(ExportFolders, AFolderMadeToHarmIsLeftAlone) {
  const std::string id = scan_.body->scan_id;
  export_fit(scan_, root_ / "one", kWhole);
  fs::rename(root_ / "one" / "fit.json", root_ / "aside.json");
  const auto is_left_alone = [&] {
    return not_deleted(root_, id) == "nothing_yet" && fs::exists(root_ / "one");
  };
  fs::create_symlink(root_ / "aside.json", root_ / "one" / "fit.json");
  EXPECT_TRUE(is_left_alone()) << "a document that is a link";
  fs::remove(root_ / "one" / "fit.json");
  ASSERT_EQ(mkfifo((root_ / "one" / "fit.json").c_str(), 0600), 0);
  EXPECT_TRUE(is_left_alone()) << "a pipe that nobody writes to";
  fs::remove(root_ / "one" / "fit.json");
  constexpr std::size_t kDeep = 1 << 20;
  std::ofstream(root_ / "one" / "fit.json") << R"({"format": "tensegric_fit/fit", "scan": )"
                                            << std::string(kDeep, '[') << std::string(kDeep, ']') << "}";
  EXPECT_TRUE(is_left_alone()) << "a document that is nested too deeply";
  fs::resize_file(root_ / "one" / "fit.json", std::uintmax_t{1} << 40);
  EXPECT_TRUE(is_left_alone()) << "a document of a terabyte";
  fs::rename(root_ / "aside.json", root_ / "one" / "fit.json");
  fs::remove(root_ / "one" / "body.ply");
  fs::create_symlink("/etc/passwd", root_ / "one" / "body.ply");
  EXPECT_EQ(not_deleted(root_, id), "bad_option") << "a link in place of a file of ours";
  EXPECT_TRUE(fs::exists(root_ / "one"));
}

TEST_F(ExportFolders, ExportsAreDeletedByScanAndNothingElseIs) {
  const std::string id = scan_.body->scan_id;
  for (const char* name : {"one", "two"}) export_fit(scan_, root_ / name, kWhole);
  export_fit(scan_, root_ / "2026" / "11" / "three", kWhole);
  export_fit(fitted("3.000000000-00000003"), root_ / "other", kWhole);
  fs::create_directories(root_ / "no_export");
  std::ofstream(root_ / "no_export" / "fit.json") << R"({"scan": {"scan_id": ")" << id << "\"}}";
  fs::create_directories(root_ / "elsewhere");
  fs::create_directory_symlink(root_ / "one", root_ / "elsewhere" / "link");

  EXPECT_EQ(not_deleted(root_ / "elsewhere", id), "nothing_yet");  // links are not followed
  EXPECT_EQ(not_deleted("relative", id), "bad_option");
  EXPECT_EQ(not_deleted(root_, ""), "bad_option");
  EXPECT_EQ(not_deleted(root_ / "nowhere", id), "cannot_write");
  std::vector<geometry::Refusal> left;
  EXPECT_EQ(delete_exports(root_.string() + "/", id, left).exports,
            (std::vector<std::string>{root_ / "2026" / "11" / "three", root_ / "one", root_ / "two"}));
  EXPECT_TRUE(left.empty());
  EXPECT_EQ(not_deleted(root_, id), "nothing_yet");
  EXPECT_TRUE(fs::exists(root_ / "other" / "fit.json"));
  EXPECT_TRUE(fs::exists(root_ / "no_export" / "fit.json"));

  std::ofstream(root_ / "other" / "precious") << "mine";
  EXPECT_EQ(not_deleted(root_, "3.000000000-00000003"), "bad_option");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "other"), {}), 19);
  fs::remove(root_ / "other" / "precious");
  EXPECT_EQ(not_deleted(root_ / "other", "3.000000000-00000003"), "");  // the export itself
  EXPECT_FALSE(fs::exists(root_ / "other"));
}

// `forget` said that nothing was left of her, and the outer one could not be deleted any more.
TEST_F(ExportFolders, AnExportInAnExportIsRefusedAndOneThatIsThereIsFound) {
  const std::string id = scan_.body->scan_id, other = "3.000000000-00000003";
  export_fit(fitted(other), root_ / "outer", kWhole);
  fs::create_directory_symlink(root_ / "outer", root_ / "link");
  for (const fs::path& place :
       {root_ / "outer" / "inner", root_ / "outer" / "2026" / "inner", root_ / "link" / "inner"}) {
    try {
      export_fit(scan_, place, kWhole);
      FAIL() << place;
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), std::string(geometry::refusal::kBadOption));
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "outer"), {}), 18);
  export_fit(scan_, root_ / "inner", kWhole);
  fs::rename(root_ / "inner", root_ / "outer" / "inner");
  std::vector<geometry::Refusal> left;
  EXPECT_EQ(delete_exports(root_, id, left).exports, std::vector<std::string>{root_ / "outer" / "inner"});
  EXPECT_TRUE(left.empty());
  export_fit(scan_, root_ / "inner", kWhole);
  fs::rename(root_ / "inner", root_ / "outer" / "inner");
  std::vector<std::string> not_deleted;
  EXPECT_EQ(delete_old_exports(root_, -1, not_deleted),
            (std::vector<std::string>{root_ / "outer" / "inner", root_ / "outer"}));
  EXPECT_TRUE(not_deleted.empty());
}

TEST_F(ExportFolders, OneThatCannotBeDeletedDoesNotKeepTheOthers) {
  for (const char* name : {"a", "b", "c"}) export_fit(scan_, root_ / name, kWhole);
  std::ofstream(root_ / "b" / "note.txt") << "mine";
  std::vector<geometry::Refusal> left;
  EXPECT_EQ(delete_exports(root_, scan_.body->scan_id, left).exports,
            (std::vector<std::string>{root_ / "a", root_ / "c"}));
  ASSERT_EQ(left.size(), 1u);
  EXPECT_NE(std::string(left[0].what()).find("note.txt"), std::string::npos);
  EXPECT_TRUE(fs::exists(root_ / "b" / "fit.json"));
}

// Another user's export may be hers: nobody may say that there is none.
TEST_F(ExportFolders, OneThatCannotBeReadIsNotSaidToBeNobodys) {
  export_fit(scan_, root_ / "one", kWhole);
  fs::permissions(root_ / "one", fs::perms::none);
  const pid_t child = fork();
  if (child == 0) {  // without the rights of root
    if (geteuid() == 0 && (chmod(root_.c_str(), 0755) != 0 || setuid(65534) != 0)) _exit(2);
    _exit(not_deleted(root_, scan_.body->scan_id) == "cannot_write" ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  fs::permissions(root_ / "one", fs::perms::owner_all);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace tensegric_fit::node
