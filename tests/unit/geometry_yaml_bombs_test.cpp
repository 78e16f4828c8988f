/// YAML files that were made to harm: refused at once, by name.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::geometry {
namespace {

namespace fs = std::filesystem;

class YamlBombs : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(path_); }

  std::string refused(const std::string& text) const {
    std::ofstream(path_) << text;
    return refused();
  }

  std::string refused() const {
    const auto start = std::chrono::steady_clock::now();
    std::string code;
    try {
      load_yaml_map(path_, refusal::kBadGarment);
    } catch (const Refusal& refusal) {
      code = refusal.code();
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    return code;
  }

  const fs::path path_ = fs::temp_directory_path() / "tensegric_fit_yaml_bomb.yaml";
};

TEST_F(YamlBombs, AliasesOfAliases) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i <= 12; ++i) {  // stands for 10^13 entries
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) text += ", " + before;
    text += "]\n";
  }
  EXPECT_EQ(refused(text), "bad_garment");
  EXPECT_EQ(refused("a: &a [1, 2]\nb: *a\nc: *a\n"), "") << "a few aliases are no harm";
}

TEST_F(YamlBombs, AnEntryThatContainsItself) {
  EXPECT_EQ(refused("a: &a [*a]\n"), "bad_garment");
  EXPECT_EQ(refused("a: &a {b: *a}\n"), "bad_garment");
}

TEST_F(YamlBombs, Depth) {
  EXPECT_EQ(refused("a: " + std::string(100000, '[')), "bad_garment");
  EXPECT_EQ(refused("a: " + std::string(200, '[') + std::string(200, ']')), "bad_garment");
  EXPECT_EQ(refused("a: " + std::string(100000, '{')), "bad_garment");
  EXPECT_EQ(refused("a: " + std::string(50, '[') + std::string(50, ']')), "");
}

TEST_F(YamlBombs, ASecondDocument) {
  EXPECT_EQ(refused("a: 1\n---\nb: 2\n"), "bad_garment");
  EXPECT_EQ(refused("a: 1\n...\nb: 2\n"), "bad_garment");
  EXPECT_EQ(refused("{a: 1},\n"), "bad_garment") << "of which yaml-cpp makes documents without end";
  EXPECT_EQ(refused("a: 1\n---\n---\nb: 2\n"), "bad_garment") << "behind an empty one";
  EXPECT_EQ(refused("# one\n---\na: 1\n...\n"), "");
  for (const char* end : {"---", "---\n", "--- # the end\n", "---\n# the end\n", "---\n...\n"})
    EXPECT_EQ(refused(std::string("a: 1\n") + end), "") << end;
}

TEST_F(YamlBombs, SizeAndWhatIsNoFile) {
  std::ofstream(path_) << "a: 1\n";
  fs::resize_file(path_, std::uintmax_t{1} << 40);
  EXPECT_EQ(refused(), "bad_garment") << "a terabyte that takes no space";
  fs::remove(path_);
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_EQ(refused(), "bad_garment") << "a pipe that nobody writes to";
  fs::remove(path_);
  fs::create_symlink("/dev/zero", path_);
  EXPECT_EQ(refused(), "bad_garment");
}

}  // namespace
}  // namespace tensegric_fit::geometry
