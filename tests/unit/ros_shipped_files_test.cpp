/// Everything under launch/ that is data loads; the launch files are checked by roslaunch-check
/// (tests/pipeline).
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "control_mesh/template.hpp"
#include "tensegric/garment.hpp"

namespace tensegric_fit {
namespace {

namespace fs = std::filesystem;

const fs::path kLaunch = fs::path(TENSEGRIC_FIT_SOURCE_DIR) / "launch";
const std::set<std::string> kStages = {"assembler", "reconstruction", "landmarks",  "control_mesh",
                                       "tensegric", "tffd",           "correlation"};

std::vector<fs::path> shipped(const std::string& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(kLaunch / folder))
    if (entry.path().extension() != ".png")
      files.push_back(entry.path());  // a garment's picture lies beside it
  std::sort(files.begin(), files.end());
  EXPECT_FALSE(files.empty()) << folder;
  return files;
}

std::set<std::string> node_names(const control_mesh::Template& pattern) {
  std::set<std::string> names;
  for (const control_mesh::TemplateNode& node : pattern.nodes) {
    names.insert(node.name);
    if (node.name.size() > 2 && node.name.substr(node.name.size() - 2) == "_L")
      names.insert(node.name.substr(0, node.name.size() - 1) + "R");
  }
  return names;
}

TEST(ShippedFiles, GarmentsFitTheirTemplates) {
  for (const fs::path& file : shipped("garments")) {
    const tensegric::Garment garment = tensegric::load_garment(file);
    EXPECT_EQ(garment.name, file.stem()) << "is called by its file's name";
    for (const std::string& region : garment.regions) {
      const auto pattern = control_mesh::load_template(kLaunch / "templates" / (region + ".yaml"));
      const std::set<std::string> names = node_names(pattern);
      for (const tensegric::GarmentLine& line : garment.lines)
        for (const std::string& name : line.through) EXPECT_EQ(names.count(name), 1u) << file << ": " << name;
    }
  }
}

TEST(ShippedFiles, TemplatesLoadAndHoldTheirOwnRegion) {
  for (const fs::path& file : shipped("templates")) {
    const control_mesh::Template pattern = control_mesh::load_template(file);
    EXPECT_EQ(pattern.name, file.stem());
    EXPECT_TRUE(std::any_of(pattern.regions.begin(), pattern.regions.end(), [&](const auto& region) {
      return region.name == file.stem();
    })) << file;
  }
}

// Whether a stage knows a parameter it says itself when it starts: pipeline.test and the replays load these
// files.
TEST(ShippedFiles, ConfigurationsNameStages) {
  for (const fs::path& file : shipped("config")) {
    const YAML::Node root = YAML::LoadFile(file);
    ASSERT_TRUE(root.IsMap()) << file;
    for (const auto& stage : root) {
      EXPECT_EQ(kStages.count(stage.first.Scalar()), 1u) << file << ": " << stage.first.Scalar();
      EXPECT_TRUE(stage.second.IsMap()) << file << ": " << stage.first.Scalar();
    }
  }
}

// What an earlier launch set would act in the next one under the same master, without a word.
TEST(ShippedFiles, NodesThatTakeConfigurationsForgetThoseOfEarlierLaunches) {
  const std::regex node("<node [^>]*name=\"([a-z_]+)\"[^>]*>");
  int found = 0;
  for (const char* name : {"pipeline.launch", "booth.launch", "depth_cameras.launch"}) {
    std::ifstream file(kLaunch / name);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::sregex_iterator match(text.begin(), text.end(), node), end; match != end; ++match) {
      if (kStages.count((*match)[1]) == 0) continue;
      ++found;
      EXPECT_NE(match->str().find("clear_params=\"true\""), std::string::npos)
          << name << ": " << match->str();
    }
  }
  EXPECT_GE(found, 6);
}

// `fit` takes the one, the nodes the other.
TEST(ShippedFiles, FineTissueIsTheSameForFitAndForNodes) {
  const YAML::Node tissue = YAML::LoadFile(kLaunch / "tissue" / "fine.yaml");
  const YAML::Node config = YAML::LoadFile(kLaunch / "config" / "fine.yaml");
  for (const auto& entry : tissue) {
    const auto key = entry.first.Scalar();
    if (key == "evidence") continue;
    // Both of them bind the body.
    const std::vector<std::string> stages = key == "thickness" ? std::vector<std::string>{"control_mesh"}
                                            : key == "beta"    ? std::vector<std::string>{"tensegric", "tffd"}
                                                               : std::vector<std::string>{"tensegric"};
    for (const std::string& stage : stages) {
      const YAML::Node value = config[stage][key];
      ASSERT_TRUE(value) << stage << "/" << key;
      EXPECT_EQ(value.Scalar(), entry.second.Scalar()) << stage << "/" << key;
    }
  }
}

TEST(ShippedFiles, RvizKnowsEveryDisplay) {
  std::ifstream description("/usr/share/rviz/plugin_description.xml");
  if (!description) GTEST_SKIP() << "rviz is not installed";
  std::ifstream own(TENSEGRIC_FIT_SOURCE_DIR "/rviz_plugins.xml");
  ASSERT_TRUE(own);
  std::string known{std::istreambuf_iterator<char>(description), {}};
  known.append(std::istreambuf_iterator<char>(own), {});
  for (const fs::path& file : shipped("rviz")) {
    const YAML::Node displays = YAML::LoadFile(file)["Visualization Manager"]["Displays"];
    ASSERT_TRUE(displays && displays.size() != 0) << file;
    for (const YAML::Node& display : displays) {
      const auto name = display["Class"].as<std::string>();
      EXPECT_NE(known.find("<class name=\"" + name + "\""), std::string::npos) << file << ": " << name;
      if (!display["Marker Topic"]) continue;
      const auto topic = display["Marker Topic"].as<std::string>();
      EXPECT_EQ(kStages.count(topic.substr(0, topic.find('/'))), 1u) << file << ": " << topic;
      EXPECT_EQ(topic.substr(topic.find('/')), "/markers") << file;
    }
  }
}

}  // namespace
}  // namespace tensegric_fit
