/// What the panel's list of garments says.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "inspect/garment_titles.hpp"

namespace tensegric_fit::inspect {
namespace {

namespace fs = std::filesystem;

TEST(GarmentTitlesTest, EveryShippedGarmentHasItsOwnTitleASentenceAndAPicture) {
  const auto garments = garments_in(TENSEGRIC_FIT_SOURCE_DIR "/launch/garments");
  std::set<std::string> titles;
  for (const GarmentTitle& garment : garments) {
    EXPECT_TRUE(titles.insert(garment.title).second) << garment.name;
    EXPECT_NE(garment.title, "") << garment.name;
    EXPECT_NE(garment.picture, "") << garment.name << ": tests/garment_pictures.py makes it";
    EXPECT_EQ(garment.about.substr(garment.about.size() - 1), ".") << garment.name;
  }
  EXPECT_EQ(garments.size(), 9u);
}

TEST(GarmentTitlesTest, ABrokenFileIsListedWithoutATitleAndAMissingFolderIsEmpty) {
  const fs::path folder = fs::temp_directory_path() / ("garment_titles_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "b.yaml") << "{{{";
  std::ofstream(folder / "a.yaml") << "title: [a, list]";
  std::ofstream(folder / "c.txt") << "title: none of ours";
  const auto garments = garments_in(folder);
  ASSERT_EQ(garments.size(), 2u);
  EXPECT_EQ(garments[0].name, "a");
  EXPECT_EQ(garments[0].title, "");
  EXPECT_EQ(garments[1].title, "");
  EXPECT_EQ(garments[1].picture, "");
  fs::remove_all(folder);
  EXPECT_TRUE(garments_in(folder).empty());
}

TEST(GarmentTitlesTest, AFileThatWasMadeToHarmHasNoTitleEither) {
  const fs::path folder = fs::temp_directory_path() / ("garment_bombs_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "large.yaml") << "title: large\n";
  fs::resize_file(folder / "large.yaml", std::uintmax_t{1} << 40);  // zeros, of no blocks
  std::ofstream(folder / "own.yaml") << "title: &a [*a]";
  const auto garments = garments_in(folder);
  fs::remove_all(folder);
  ASSERT_EQ(garments.size(), 2u);
  EXPECT_EQ(garments[0].title, "");
  EXPECT_EQ(garments[1].title, "");
}

}  // namespace
}  // namespace tensegric_fit::inspect
