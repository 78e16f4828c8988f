/// replay_test CASE.yaml OUT.bag: waits for the bag of a replay and compares it with the case.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "fit_metrics.hpp"
#include "geometry/checked_yaml.hpp"

namespace tensegric_fit::tests {
namespace {

using namespace std::chrono_literals;

const char* case_file = nullptr;
const char* out_bag = nullptr;

TEST(Replay, GivesWhatTheCaseExpects) {
  const YAML::Node root = geometry::load_yaml_map(case_file, "bad_case");
  geometry::check_keys(root, {"scan", "metrics"}, case_file, "bad_case");
  const auto end = std::chrono::steady_clock::now() + 150s;
  while (!std::filesystem::exists(out_bag) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(std::filesystem::exists(out_bag)) << "the replay wrote nothing";

  const std::map<std::string, double> metrics = fit_metrics(out_bag);
  std::filesystem::remove(out_bag);
  for (const auto& [name, value] : metrics) std::cout << name << ": " << value << '\n';
  ASSERT_TRUE(root["metrics"].IsSequence() && root["metrics"].size() != 0);
  for (const YAML::Node& metric : root["metrics"]) {
    geometry::check_keys(metric, {"name", "expected", "tolerance", "reason"}, case_file, "bad_case");
    const auto name = geometry::required<std::string>(metric, "name", case_file, "bad_case");
    const auto expected = geometry::required<double>(metric, "expected", name, "bad_case");
    const auto tolerance = geometry::required<double>(metric, "tolerance", name, "bad_case");
    const auto reason = geometry::required<std::string>(metric, "reason", name, "bad_case");
    ASSERT_EQ(metrics.count(name), 1u) << name << " was not found in the fit";
    EXPECT_NEAR(metrics.at(name), expected, tolerance) << name << " (" << reason << ")";
  }
}

}  // namespace
}  // namespace tensegric_fit::tests

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc < 3) return 2;
  tensegric_fit::tests::case_file = argv[1];
  tensegric_fit::tests::out_bag = argv[2];
  std::cout.precision(10);
  return RUN_ALL_TESTS();
}
