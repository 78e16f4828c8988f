/// Bad scans and bad parameters: each refused by name, and the chain goes on.
#include <gtest/gtest.h>
#include <pcl_conversions/pcl_conversions.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>

#include "chain_client.hpp"
#include "geometry/point_cloud.hpp"

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
  sensor_msgs::PointCloud2 too_wide = booth_scan("a"), too_narrow = too_wide;
  ++too_wide.width;
  --too_narrow.width;
  too_narrow.row_step -= too_narrow.point_step;  // else the last point would be padding
  sensor_msgs::PointCloud2 whole_numbers = cloud_of(Points(20000, {0, 0, 0}));
  for (sensor_msgs::PointField& field : whole_numbers.fields) field.datatype = sensor_msgs::PointField::INT32;
  return {{"no points", cloud_of({}), {"empty_cloud"}},
          {"all NaN", cloud_of(Points(20000, {nan, nan, nan})), {"non_finite"}},
          {"a few points", cloud_of({{0, 0, 0}, {0, 0, 1.7f}, {0.3f, 0, 1}}), {"too_few_points"}},
          {"no z", wrong_fields, {"wrong_fields"}},
          {"x y z are integers", whole_numbers, {"wrong_fields"}},
          {"shorter than it says", truncated, {"broken_file"}},
          {"wider than its data", too_wide, {"broken_file"}},
          {"narrower than its data", too_narrow, {"broken_file"}},
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

/// The same points in other bytes: `names` in steps of `step` (8 bytes each as doubles, else 4), `columns` to
/// a row, rows `padding` bytes longer than their points.
struct Layout {
  std::string name;
  std::vector<std::string> names;
  bool doubles, big_endian;
  std::uint32_t step, columns, padding;
};

sensor_msgs::PointCloud2 laid_out(const Points& points, const Layout& layout) {
  sensor_msgs::PointCloud2 cloud = cloud_of({});
  const std::uint32_t size = layout.doubles ? 8 : 4;
  cloud.fields.clear();
  for (const std::string& name : layout.names) {
    sensor_msgs::PointField& field = cloud.fields.emplace_back();
    field.name = name;
    field.count = 1;
    field.datatype = layout.doubles ? sensor_msgs::PointField::FLOAT64 : sensor_msgs::PointField::FLOAT32;
    field.offset = size * static_cast<std::uint32_t>(cloud.fields.size() - 1);
  }
  cloud.is_bigendian = layout.big_endian;
  cloud.point_step = layout.step;
  cloud.width = layout.columns;
  cloud.height = static_cast<std::uint32_t>(points.size()) / layout.columns;
  cloud.row_step = layout.columns * layout.step + layout.padding;
  cloud.data.assign(static_cast<std::size_t>(cloud.height) * cloud.row_step, 0xa5);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t f = 0; f < layout.names.size(); ++f) {
      const std::size_t axis = layout.names[f][0] - 'x';
      if (axis > 2) continue;  // another field: whatever stands there
      std::uint8_t* at = &cloud.data[i / layout.columns * cloud.row_step + i % layout.columns * layout.step +
                                     cloud.fields[f].offset];
      const float single = points[i][axis];
      const double twice = single;
      if (layout.doubles)
        std::memcpy(at, &twice, size);
      else
        std::memcpy(at, &single, size);
      if (layout.big_endian) std::reverse(at, at + size);  // this host is not
    }
  }
  return cloud;
}

/// As the reconstruction reads it.
std::vector<Eigen::Vector3d> points_read(const sensor_msgs::PointCloud2& message) {
  pcl::PCLPointCloud2 cloud;
  pcl_conversions::toPCL(message, cloud);
  return geometry::points_of(cloud).points;
}

TEST_F(BadInputTest, TheSamePointsInAnotherLayoutGiveTheSameBody) {
  const Points points = points_of(booth_scan("a"));
  ASSERT_EQ(points.size() % 100, 0u);
  const auto all = static_cast<std::uint32_t>(points.size());
  const std::vector<std::string> xyz = {"x", "y", "z"};
  const std::vector<Layout> layouts = {
      {"plain", xyz, false, false, 12, all, 0},
      {"another order", {"intensity", "z", "x", "y"}, false, false, 16, all, 0},
      {"doubles", xyz, true, false, 24, all, 0},
      {"big-endian", xyz, false, true, 12, all, 0},
      {"big-endian doubles, padded points", xyz, true, true, 37, all, 0},
      {"padded points and rows", xyz, false, false, 20, 100, 7}};
  const std::vector<Eigen::Vector3d> plain = points_read(laid_out(points, layouts[0]));
  EXPECT_EQ(plain.size(), points.size());
  for (const Layout& layout : layouts)
    EXPECT_TRUE(points_read(laid_out(points, layout)) == plain) << layout.name;

  // One that is odd in order, size, byte order and padding goes through the chain, too.
  const Layout odd = {"all at once", {"intensity", "z", "x", "y"}, true, true, 37, 100, 7};
  EXPECT_TRUE(points_read(laid_out(points, odd)) == plain);
  std::vector<std::vector<float>> bodies;
  for (const Layout& layout : {layouts[0], odd}) {
    client_.forget();
    const std::string scan_id = client_.send(laid_out(points, layout));
    ASSERT_TRUE(wait_for([&] { return count_of(client_.bodies, scan_id) == 1; })) << layout.name;
    bodies.push_back(client_.bodies.back()->vertices);
  }
  EXPECT_EQ(bodies[0], bodies[1]);
}

/// Exit code of a stage node that is started with one parameter, of which it should say that refusal.
int exit_code(const std::string& program, const std::string& parameter,
              const std::string& refusal = "bad_option") {
  static int started = 0;  // parameters stay with the master: each needs a name of its own
  const std::string name = "misled_" + std::to_string(++started), words = testing::TempDir() + name;
  const std::string command = std::string("timeout 20 ") + TENSEGRIC_FIT_PROGRAMS + "/" + program +
                              " __name:=" + name + " " + parameter + " > " + words + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream file(words);
  const std::string said(std::istreambuf_iterator<char>(file), {});
  EXPECT_NE(said.find(": " + refusal + ": "), std::string::npos) << program << " said: " << said;
  std::filesystem::remove(words);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(BadInputTest, NodesRefuseParametersThatTheyDoNotKnowOrThatAreOutOfRange) {
  constexpr int kRefused = 2;
  EXPECT_EQ(exit_code("reconstruction_node", "_body_trianglez:=62000"), kRefused);
  EXPECT_EQ(exit_code("reconstruction_node", "_body_triangles:=-1"), kRefused);
  EXPECT_EQ(exit_code("reconstruction_node", "_body_triangles:=many"), kRefused);
  EXPECT_EQ(exit_code("assembler_node", ""), kRefused);  // no sensors
  EXPECT_EQ(exit_code("assembler_node", "_sensors:=here/points"), kRefused);
  EXPECT_EQ(exit_code("landmarks_node", "_nose:=1"), kRefused);
  EXPECT_EQ(exit_code("control_mesh_node", "_template:=no_such_template", "bad_template"), kRefused);
  EXPECT_EQ(exit_code("tensegric_node", "_solver:=magic"), kRefused);
  EXPECT_EQ(exit_code("tensegric_node", "_garment:=no_such_garment", "bad_garment"), kRefused);
  EXPECT_EQ(exit_code("tffd_node", "_beta:=-1"), kRefused);
}

}  // namespace
}  // namespace tensegric_fit::tests
