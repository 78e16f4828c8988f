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
  EXPECT_EQ(log_words("bust 94.2 cm (+1,5), line B1 of bust_point_2: -3 mm."),
            "bust # cm (+#), line B1 of bust_point_2: -# mm.");
  EXPECT_EQ(log_words("7"), "#");
  EXPECT_EQ(log_words(""), "");
}

TEST(LogWords, FilesAreLeftOutAndTopicsStay) {
  EXPECT_EQ(log_words("bad_option: '/tmp/fits/Anna Muster' is there already and is not overwritten"),
            "bad_option: '(file)' is there already and is not overwritten");
  EXPECT_EQ(log_words("/tmp/4711_Mueller.ply: scans are not read; nothing on /booth_1/scan/points."),
            "(file): scans are not read; nothing on /booth_1/scan/points.");
  EXPECT_EQ(log_words("/tmp/Muster Anna 4711.ply: is truncated"), "(file): is truncated");
  EXPECT_EQ(log_words("'/tmp/Ann O'Brien.ply' cannot be read"), "'(file)' cannot be read");
  EXPECT_EQ(log_words("/nowhere/Jane_Doe.ply: is truncated"), "(file): is truncated");
  EXPECT_EQ(log_words("cannot get file size: No such file [/tmp/Jane Doe.ply]"),
            "cannot get file size: No such file [(file)]");
  EXPECT_EQ(log_words("Wrote 7 files into /home."), "Wrote # files into (file).");
  EXPECT_EQ(log_words("anna_4711.ply (of Muster.bag) and/or km/h"), "(file) (of (file)) and/or km/h");
  EXPECT_EQ(log_words("ANNA.PLY: is truncated"), "(file): is truncated");
  EXPECT_EQ(log_words("/tmp/Muster, Anna Maria.ply: is truncated"), "(file): is truncated");
}

TEST(LogWords, WhichPartABodyLacksIsLeftOut) {
  EXPECT_EQ(log_words("missing_part:underbust_L: the landmark underbust_L was not found"), "missing_part");
  EXPECT_EQ(log_words("7 scans; landmarks: missing_part: her left hand"), "# scans; landmarks: missing_part");
}

/// Figures that a launch file gives are nobody's; names of files may be.
TEST(LogWords, OfAStartFilesAloneAreLeftOut) {
  EXPECT_EQ(without_files("parameter 'rate': 2000 is not within 0 to 1000"),
            "parameter 'rate': 2000 is not within 0 to 1000");
  EXPECT_EQ(without_files("parameter 'file': there is no file or folder '/tmp/Anna Muster.ply'"),
            "parameter 'file': there is no file or folder '(file)'");
}

/// In every call that writes to the log, sentences go through log_words, or at a start without_files, and the
/// only number is a time.
TEST(LogWords, NoLogCallSaysAFigure) {
  const std::set<std::string> of_a_start{"run_node.hpp", "replay_node.cpp"};
  const std::regex call(R"(ROS_(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*\s*\(([^;]*)\);)");
  const std::regex text(R"("(?:[^"\\]|\\.)*")"), checked(R"(log_words\([^,;]*\)\.c_str\(\))"),
      checked_at_start(R"(without_files\([^,;]*\)\.c_str\(\))"),
      sentence(R"(\b(message|words|what|warning|left_out|metres|points)\b)"), number("%[^sd]*[fgu]");
  int calls = 0;
  for (const auto& entry : fs::recursive_directory_iterator(TENSEGRIC_FIT_SOURCE_DIR "/nodes")) {
    const std::string ending = entry.path().extension(), name = entry.path().filename();
    if (ending != ".cpp" && ending != ".hpp") continue;
    std::ifstream file(entry.path());
    const std::string source(std::istreambuf_iterator<char>(file), {});
    for (std::sregex_iterator found(source.begin(), source.end(), call), end; found != end;
         ++found, ++calls) {
      const std::string said = (*found)[1];
      const std::regex& allowed = of_a_start.count(name) != 0 ? checked_at_start : checked;
      const std::string open = std::regex_replace(std::regex_replace(said, text, ""), allowed, "");
      EXPECT_FALSE(std::regex_search(open, sentence)) << name << ": " << said;
      const std::string numbers = std::regex_replace(said, std::regex(R"(in %\.1f ms)"), "");
      EXPECT_FALSE(std::regex_search(numbers, number)) << name << ": " << said;
    }
  }
  EXPECT_GT(calls, 10);
}

}  // namespace
}  // namespace tensegric_fit::node
