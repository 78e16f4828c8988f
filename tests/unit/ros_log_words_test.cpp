/// What may stand in a log: no figure of a person.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "ros/log_words.hpp"

namespace tensegric_fit::node {
namespace {

namespace fs = std::filesystem;

TEST(LogWords, FiguresAreLeftOutAndNamesStay) {
  EXPECT_EQ(without_figures("bust 94.2 cm (+1,5), line B1 of bust_point_2: -3 mm."),
            "bust # cm (+#), line B1 of bust_point_2: -# mm.");
  EXPECT_EQ(without_figures("7"), "#");
  EXPECT_EQ(without_figures(""), "");
}

/// In every call that writes to the log, sentences go through without_figures, and the only number is a time.
TEST(LogWords, NoLogCallSaysAFigure) {
  const std::set<std::string> of_a_start{"run_node.hpp", "replay_node.cpp"};  // of parameters and files
  const std::regex call(R"(ROS_(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*\s*\(([^;]*)\);)");
  const std::regex text(R"("(?:[^"\\]|\\.)*")"), checked(R"(without_figures\([^,;]*\)\.c_str\(\))"),
      sentence(R"(\b(message|words|what|warning|left_out|metres|points)\b)"), number("%[^sd]*[fgu]");
  int calls = 0;
  for (const auto& entry : fs::recursive_directory_iterator(TENSEGRIC_FIT_SOURCE_DIR "/nodes")) {
    const std::string ending = entry.path().extension(), name = entry.path().filename();
    if ((ending != ".cpp" && ending != ".hpp") || of_a_start.count(name) != 0) continue;
    std::ifstream file(entry.path());
    const std::string source(std::istreambuf_iterator<char>(file), {});
    for (std::sregex_iterator found(source.begin(), source.end(), call), end; found != end;
         ++found, ++calls) {
      const std::string said = (*found)[1];
      const std::string open = std::regex_replace(std::regex_replace(said, text, ""), checked, "");
      EXPECT_FALSE(std::regex_search(open, sentence)) << name << ": " << said;
      const std::string numbers = std::regex_replace(said, std::regex(R"(in %\.1f ms)"), "");
      EXPECT_FALSE(std::regex_search(numbers, number)) << name << ": " << said;
    }
  }
  EXPECT_GT(calls, 10);
}

}  // namespace
}  // namespace tensegric_fit::node
