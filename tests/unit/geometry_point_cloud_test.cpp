// Layouts that a cloud can have, and those that contradict themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "geometry/point_cloud.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

using Field = pcl::PCLPointField;

/// 3 x 2 points, x y z as float32 in steps of 16, rows 4 bytes longer than their points.
struct Organised {
  Organised() {
    cloud.fields = {{"x", 0, Field::FLOAT32, 1}, {"y", 4, Field::FLOAT32, 1}, {"z", 8, Field::FLOAT32, 1}};
    cloud.point_step = 16;
    cloud.width = 3;
    cloud.height = 2;
    cloud.row_step = 3 * 16 + 4;
    cloud.data.assign(2 * cloud.row_step, 0xff);
    for (std::uint32_t row = 0; row < 2; ++row) {
      for (std::uint32_t column = 0; column < 3; ++column) {
        const float xyz[3] = {1.5f * row, -0.25f * column, 7};
        std::memcpy(&cloud.data[row * cloud.row_step + column * 16], xyz, sizeof xyz);
        points.emplace_back(xyz[0], xyz[1], xyz[2]);
      }
    }
  }
  pcl::PCLPointCloud2 cloud;
  std::vector<Eigen::Vector3d> points;
};

std::string refusal_of_cloud(const pcl::PCLPointCloud2& cloud) {
  try {
    points_of(cloud);
  } catch (const Refusal& refusal) {
    return refusal.code();
  }
  return "accepted";
}

TEST(PointsOf, RowsMayBePaddedAndTheLastOneNeedNotBe) {
  Organised organised;
  EXPECT_EQ(points_of(organised.cloud).points, organised.points);
  organised.cloud.data.resize(organised.cloud.data.size() - 4);
  EXPECT_EQ(points_of(organised.cloud).points, organised.points);
}

TEST(PointsOf, ReadsTheOtherByteOrder) {
  Organised organised;
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t field = 0; field < 3; ++field) {
        const auto at = organised.cloud.data.begin() +
                        static_cast<std::ptrdiff_t>(row * organised.cloud.row_step + 16 * column + 4 * field);
        std::reverse(at, at + 4);
      }
  organised.cloud.is_bigendian = !organised.cloud.is_bigendian;
  EXPECT_EQ(points_of(organised.cloud).points, organised.points);
}

TEST(PointsOf, ASensorOfOneByteIsKept) {
  Organised organised;
  for (std::size_t i = 0; i < 6; ++i)
    organised.cloud.data[i / 3 * organised.cloud.row_step + 16 * (i % 3) + 13] =
        static_cast<std::uint8_t>(40 * i);
  EXPECT_TRUE(points_of(organised.cloud).sensor.empty());
  organised.cloud.fields.push_back({"sensor", 13, Field::UINT8, 1});
  EXPECT_EQ(points_of(organised.cloud).sensor, (std::vector<int>{0, 40, 80, 120, 160, 200}));
  organised.cloud.fields.back().datatype = Field::FLOAT32;  // somebody else's
  EXPECT_TRUE(points_of(organised.cloud).sensor.empty());
  organised.cloud.fields.back() = {"sensor", 16, Field::UINT8, 1};
  EXPECT_EQ(refusal_of_cloud(organised.cloud), "wrong_fields");
}

TEST(PointsOf, ASizeThatTheDataContradictIsRefused) {
  const auto changed = [](auto change) {
    Organised organised;
    change(organised.cloud);
    return refusal_of_cloud(organised.cloud);
  };
  using Cloud = pcl::PCLPointCloud2;
  EXPECT_EQ(changed([](Cloud& c) { c.width = 4; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.height = 3; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.height = 1; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.width = 0; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.row_step = 40; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.data.resize(c.data.size() - 5); }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.data.push_back(0); }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.width = c.height = 0xffffffff; }), "broken_file");
  EXPECT_EQ(changed([](Cloud& c) { c.point_step = 0; }), "wrong_fields");
  EXPECT_EQ(changed([](Cloud& c) { c.fields[1].offset = 0xffffffff; }), "wrong_fields");
}

TEST(PointsOf, ManyRowsOfNothingAreNoPoints) {
  Organised organised;
  organised.cloud.fields.push_back({"sensor", 12, Field::UINT8, 1});  // for seconds; found by fuzzing
  organised.cloud.width = 0;
  organised.cloud.height = 0xffffffff;
  organised.cloud.data.clear();
  EXPECT_TRUE(points_of(organised.cloud).points.empty());
}

TEST(Joined, CloudsOfOnePersonKeepTheirSensorsApart) {
  const PointCloud trunk{{{0, 0, 1}, {0, 0, 2}}, {}, {0, 2}}, arm{{{1, 0, 1}}, {{1, 0, 0}}, {0}},
      leg{{{0, 1, 0}}, {}, {}};
  const PointCloud all = joined({trunk, arm, leg});
  ASSERT_EQ(all.points.size(), 4U);
  EXPECT_EQ(all.points[2], arm.points[0]);
  EXPECT_EQ(all.sensor, (std::vector<int>{0, 2, 3, -1}));
  ASSERT_EQ(all.normals.size(), 4U);
  EXPECT_EQ(all.normals[0], Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(all.normals[2], arm.normals[0]);
  EXPECT_TRUE(joined({leg, leg}).sensor.empty());
  EXPECT_TRUE(joined({leg, leg}).normals.empty());
  EXPECT_EQ(joined({arm}).sensor, arm.sensor);
}

TEST(Joined, APartWithoutPointsIsRefused) {
  const PointCloud arm{{{1, 0, 1}}, {}, {}};
  try {
    joined({arm, PointCloud()});
    FAIL();
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), std::string(refusal::kEmptyCloud));
  }
}

}  // namespace
}  // namespace tensegric_fit::geometry
