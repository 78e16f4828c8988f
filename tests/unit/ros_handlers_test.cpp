/// What stages do with messages, without a master.
#include <fmt/format.h>
#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include "control_mesh/control_mesh_handler.hpp"
#include "fit/bind_body.hpp"
#include "geometry/status.hpp"
#include "reconstruction/reconstruction_handler.hpp"
#include "reconstruction/validate.hpp"
#include "ros/body_messages.hpp"
#include "tensegric/tensegric_handler.hpp"
#include "tffd/tffd_handler.hpp"

namespace tensegric_fit::node {
namespace {

Parameters parameters(const std::string& yaml) {
  return {YAML::Load(yaml), "stage"};
}

template <typename Read>
std::string refusal_of(const Read& read) {
  try {
    read();
  } catch (const geometry::Refusal& refusal) {
    return refusal.what();
  }
  return "accepted";
}

TEST(ReconstructionHandler, NamesWhatAHeaderLacks) {
  std_msgs::Header header;
  EXPECT_EQ(lacks_of(header).rfind("no_stamp: ", 0), 0u);
  EXPECT_NE(lacks_of(header).find(" no_frame: "), std::string::npos);
  header.frame_id = "booth";
  EXPECT_EQ(lacks_of(header).find("no_frame"), std::string::npos);
  header.stamp = ros::Time(1);
  EXPECT_EQ(lacks_of(header), "");
  const std::string frame = header.frame_id;
  EXPECT_EQ(lacks_of(header, {"floor", frame}), "");
  EXPECT_EQ(lacks_of(header, {"floor", "body"}).rfind("unknown_frame: ", 0), 0u);
  EXPECT_EQ(lacks_of(header, {"booth_2/booth"}), "") << "another booth's";
  header.frame_id = "/booth";
  EXPECT_EQ(lacks_of(header, {"booth", "floor"}).rfind("unknown_frame: ", 0), 0u) << "tf has no such frame";
}

// A misspelt frame was known from the second customer on: landmarks had published where she stood in it. A
// tf2 listener does not know who publishes.
TEST(ReconstructionHandler, WhatTheChainItselfPublishesOnTfIsNotKnown) {
  tf2::BufferCore tf;
  const auto known = [&tf] { return frames_of_others(tf.allFramesAsYAML(), "shop/body"); };
  const auto add = [&tf](const std::string& parent, const std::string& child) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.rotation.w = 1;
    ASSERT_TRUE(tf.setTransform(transform, "unknown_publisher", true));
  };
  EXPECT_TRUE(known().empty());
  add("shop/boot", "shop/body");
  EXPECT_TRUE(known().empty());
  add("shop_2/booth", "shop_2/body");
  EXPECT_TRUE(known().empty());
  add("booth", "sensor_0");
  add("map", "booth");
  EXPECT_EQ(known(), (std::vector<std::string>{"booth", "map", "sensor_0"}));
  EXPECT_TRUE(frames_of_others("a: [", "body").empty());
  EXPECT_TRUE(frames_of_others("a: b", "body").empty());
}

TEST(ReconstructionHandler, FarFromTheOriginAScanIsRefusedByName) {
  const ReconstructionHandler handler(parameters("{}"));
  for (const bool is_double : {true, false}) {
    sensor_msgs::PointCloud2 cloud;
    cloud.header.frame_id = "map";
    cloud.height = 1;
    const std::uint32_t size = is_double ? 8 : 4;
    for (const char* name : {"x", "y", "z"}) {
      sensor_msgs::PointField field;
      field.name = name;
      field.offset = size * static_cast<std::uint32_t>(cloud.fields.size());
      field.datatype = is_double ? sensor_msgs::PointField::FLOAT64 : sensor_msgs::PointField::FLOAT32;
      field.count = 1;
      cloud.fields.push_back(field);
    }
    cloud.point_step = 3 * size;
    const auto add = [&](auto x, auto y, auto z) {
      for (const auto value : {x, y, z}) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
        cloud.data.insert(cloud.data.end(), bytes, bytes + size);
      }
      ++cloud.width;
    };
    for (int i = 0; i < 20000; ++i) {  // as of UTM
      const double angle = 0.1 * i, x = 4e5 + 0.2 * std::cos(angle), y = 5e6 + 0.1 * std::sin(angle),
                   z = 8.5e-5 * i;
      if (is_double)
        add(x, y, z);
      else
        add(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }
    cloud.row_step = cloud.width * cloud.point_step;
    try {
      handler.handle(cloud, {});
      FAIL() << "her measures would be of coordinates half a metre apart";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), std::string(geometry::refusal::kNoTransform)) << refusal.what();
      EXPECT_NE(std::string(refusal.what()).find("400 km from the origin of frame 'map'"), std::string::npos)
          << refusal.what();
    }
  }
}

TEST(ReconstructionHandler, NamesSomebodyElseInTheScan) {
  body_model::RegisteredBody body;
  body.joints = {{1, 0, 1}};
  body.unexplained = {{{1, 0.5, 1}, 0.3, 0.02, "a bag"}};
  EXPECT_EQ(company_of(body), "");
  body.unexplained.push_back({{1, 1.2, 0.3}, 1.7, 0.5, "somebody else", true});
  EXPECT_EQ(company_of(body).rfind("two_persons: ", 0), 0u);
  EXPECT_NE(company_of(body).find(" 1.2 m from her"), std::string::npos);
}

TEST(Parameters, FromAFileAreReadAndCheckedLikeThoseOfANode) {
  Parameters given = parameters("{count: 7, size: 2, exact: true, word: b, name: '12', way: [0, 0.5, -1]}");
  EXPECT_EQ(given.integer("count", 1, {0, 10}), 7);
  EXPECT_EQ(given.number("size", 1, {0, 10}), 2);
  EXPECT_EQ(given.number("absent", 1.5, {0, 10}), 1.5);
  EXPECT_TRUE(given.flag("exact", false));
  EXPECT_EQ(given.choice("word", "a", {"a", "b"}), "b");
  EXPECT_EQ(given.text("name", ""), "12");  // in quotes: no number
  EXPECT_EQ(given.vector("way", Eigen::Vector3d::Zero()), Eigen::Vector3d(0, 0.5, -1));
  EXPECT_NO_THROW(given.check_all_known());
}

TEST(Parameters, AreRefusedByName) {
  const auto refused = [](const std::string& yaml, const auto& read) {
    return refusal_of([&] {
      Parameters given = parameters(yaml);
      read(given);
      given.check_all_known();
    });
  };
  const auto count = [](Parameters& p) { p.integer("count", 1, {0, 10}); };
  EXPECT_EQ(refused("{count: 11}", count), "parameter '/stage/count' is 11, not in [0, 10]");
  EXPECT_EQ(refused("{count: 1e300}", count), "parameter '/stage/count' is 1e+300, not in [0, 10]");
  EXPECT_EQ(refused("{count: 1.5}", count), "parameter '/stage/count' is not an integer");
  EXPECT_EQ(refused("{count: many}", count), "parameter '/stage/count' is not an integer");
  EXPECT_EQ(refused("{cuont: 1}", count), "parameter '/stage/cuont' is unknown; the node knows: count");
  EXPECT_EQ(refused("{way: [1, 2]}", [](Parameters& p) { p.vector("way", Eigen::Vector3d::Zero()); }),
            "parameter '/stage/way' is not a list of three numbers");
  EXPECT_EQ(refused("[1]", count), "parameters of 'stage' are not a map");
}

TEST(Parameters, ThatANodeTakesAreNotRefusedByItsCore) {
  const auto end = [](const char* name, double value) {
    Parameters given = parameters(fmt::format("{{{}: {}}}", name, value));
    return refusal_of([&] { reconstruction::check_options(reconstruction_options(given)); });
  };
  using geometry::Range;
  for (const auto& [name, range] :
       {std::pair<const char*, Range>{"body_triangles", reconstruction::kBodyTriangles},
        {"poisson_depth", reconstruction::kPoissonDepth},
        {"min_points", reconstruction::kMinPoints},
        {"max_points", {reconstruction::kMinPoints.high, reconstruction::kMaxPoints.high}},
        {"support_distance", reconstruction::kSupportDistance}})
    for (const double value : {range.low, range.high}) EXPECT_EQ(end(name, value), "accepted") << name;
  EXPECT_EQ(end("min_points", 499), "parameter '/stage/min_points' is 499, not in [500, 1000000]");
  EXPECT_NE(end("max_points", 4999), "accepted");  // fewer than the least
  EXPECT_NE(refusal_of([] { TffdHandler{parameters("{beta: 0.5}")}; }), "accepted");
  EXPECT_NE(refusal_of([] { TensegricHandler(parameters("{beta: 0.5}"), fit::bind_body); }), "accepted");
}

TEST(ControlMeshHandler, RefusesACoarseMeshThatIsNoCoarser) {
  const auto said = [](const std::string& yaml) {
    return refusal_of([&] { ControlMeshHandler{parameters(yaml)}; });
  };
  EXPECT_EQ(said("{control_triangles: 480, coarse_triangles: 120}"), "accepted");
  EXPECT_EQ(said("{control_triangles: 480, coarse_triangles: 480}"),
            "coarse_triangles is 480, not less than control_triangles (480)");
}

}  // namespace
}  // namespace tensegric_fit::node
