/// Bad scans and bad parameters: each refused by name, and the chain goes on.
#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>

#include "chain_client.hpp"

namespace tensegric_fit::tests {
namespace {

using Points = std::vector<std::array<float, 3>>;

sensor_msgs::PointCloud2 cloud_of(const Points& points) {
  static std::uint32_t second = 5000;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = ros::Time(++second, 0);
  cloud.header.frame_id = "booth";
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(points.size());
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x");
  for (const std::array<float, 3>& point : points) {
    std::copy(point.begin(), point.end(), &*x);
    ++x;
  }
  return cloud;
}

Points points_of(const sensor_msgs::PointCloud2& cloud) {
  Points points;
  for (sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"), y(cloud, "y"), z(cloud, "z"); x != x.end();
       ++x, ++y, ++z)
    points.push_back({*x, *y, *z});
  return points;
}

Points box(double width, double depth, double height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0, 1);
  Points points;
  for (int i = 0; i < 60000; ++i) {
    std::array<float, 3> point = {unit(random), unit(random), unit(random)};
    point[i % 3] = static_cast<float>((i / 3) % 2);  // on one of the six sides
    points.push_back({static_cast<float>(point[0] * width), static_cast<float>(point[1] * depth),
                      static_cast<float>(point[2] * height)});
  }
  return points;
}

struct BadScan {
  std::string name;
  sensor_msgs::PointCloud2 cloud;
  std::set<std::string> codes;
};

std::vector<BadScan> bad_scans() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Points millimetres = points_of(booth_scan("a"));
  for (auto& point : millimetres)
    for (float& coordinate : point) coordinate *= 1000;
  sensor_msgs::PointCloud2 wrong_fields = cloud_of(Points(20000, {0, 0, 0}));
  wrong_fields.fields[2].name = "intensity";
  sensor_msgs::PointCloud2 truncated = booth_scan("a");
  truncated.data.resize(truncated.data.size() / 2);
  return {{"no points", cloud_of({}), {"empty_cloud"}},
          {"all NaN", cloud_of(Points(20000, {nan, nan, nan})), {"non_finite"}},
          {"a few points", cloud_of({{0, 0, 0}, {0, 0, 1.7f}, {0.3f, 0, 1}}), {"too_few_points"}},
          {"no z", wrong_fields, {"wrong_fields"}},
          {"shorter than it says", truncated, {"broken_file"}},
          {"millimetres", cloud_of(millimetres), {"wrong_unit"}},
          {"a box", cloud_of(box(0.5, 0.4, 1.7)), {"not_a_body"}}};
}

class BadInputTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(client_.ready()) << "the chain did not come up"; }
  ChainClient client_;
};

TEST_F(BadInputTest, EachIsRefusedByNameAndTheNextGoodScanWorks) {
  listen(0.5);  // latched messages of earlier scans
  client_.forget();
  std::map<std::string, std::string> refused;  // name by scan_id
  for (const BadScan& bad : bad_scans()) {
    const std::string scan_id = client_.send(bad.cloud);
    EXPECT_TRUE(wait_for([&] { return client_.refusal_of(scan_id) != ""; })) << bad.name;
    const std::string code = client_.refusal_of(scan_id);
    EXPECT_EQ(bad.codes.count(code.substr(0, code.find(':'))), 1u) << bad.name << ": " << code;
    refused[scan_id] = bad.name;
  }
  EXPECT_NE(client_.fit(booth_scan("a")), "");
  for (const auto& [scan_id, name] : refused)
    EXPECT_EQ(count_of(client_.landmarks, scan_id) + count_of(client_.fits, scan_id) +
                  count_of(client_.deformed, scan_id),
              0)
        << name;
}

/// Exit code of a stage node that is started with one parameter.
int exit_code(const std::string& program, const std::string& parameter) {
  const std::string command = std::string("timeout 20 ") + TENSEGRIC_FIT_PROGRAMS + "/" + program +
                              " __name:=misled_" + program + " " + parameter + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(BadInputTest, NodesRefuseParametersThatTheyDoNotKnowOrThatAreOutOfRange) {
  constexpr int kRefused = 2;
  EXPECT_EQ(exit_code("reconstruction_node", "_body_trianglez:=62000"), kRefused);
  EXPECT_EQ(exit_code("reconstruction_node", "_body_triangles:=-1"), kRefused);
  EXPECT_EQ(exit_code("reconstruction_node", "_body_triangles:=many"), kRefused);
  EXPECT_EQ(exit_code("landmarks_node", "_nose:=1"), kRefused);
  EXPECT_EQ(exit_code("control_mesh_node", "_template:=no_such_template"), kRefused);
  EXPECT_EQ(exit_code("tensegric_node", "_solver:=magic"), kRefused);
  EXPECT_EQ(exit_code("tensegric_node", "_garment:=no_such_garment"), kRefused);
  EXPECT_EQ(exit_code("tffd_node", "_beta:=-1"), kRefused);
}

}  // namespace
}  // namespace tensegric_fit::tests

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bad_input_test");
  ros::NodeHandle node;  // keeps ROS up between clients
  return RUN_ALL_TESTS();
}
