// The GLB writer: what it writes is read again here, from its bytes.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "geometry/status.hpp"
#include "mesh_files/frame.hpp"
#include "mesh_files/glb.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

geometry::TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

GlbMesh coloured_body() {
  GlbMesh body{"body", tetrahedron()};
  body.colours.assign(4, {255, 0, 128});
  body.scalars = {{"_DISTORTION", {1, 0.5F, 1, 2}}};
  GlbMorph worn{"under the garment", body.shape.vertices};
  for (Vector3d& p : worn.vertices) p *= 0.9;
  body.morphs = {worn};
  return body;
}

struct Glb {
  nlohmann::json json;
  std::string data;

  explicit Glb(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number(bytes, 4), 2U);
    EXPECT_EQ(number(bytes, 8), bytes.size());
    const std::uint32_t text = number(bytes, 12);
    json = nlohmann::json::parse(bytes.substr(20, text));
    EXPECT_EQ(text % 4, 0U);
    EXPECT_EQ(number(bytes, 20 + text) + 28 + text, bytes.size());
    data = bytes.substr(28 + text);
  }

  static std::uint32_t number(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  }

  template <typename T>
  std::vector<T> values(std::size_t accessor) const {
    const auto& entry = json["accessors"][accessor];
    const auto& view = json["bufferViews"][entry["bufferView"].get<std::size_t>()];
    const std::size_t length = view["byteLength"], offset = view["byteOffset"];
    EXPECT_LE(offset + length, data.size());
    std::vector<T> result(length / sizeof(T));
    std::memcpy(static_cast<void*>(result.data()), data.data() + offset, length);
    return result;
  }
};

TEST(Glb, HasTheMeshInItsAxes) {
  const GlbMesh body = coloured_body();
  const Glb glb(glb_bytes({body}));
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto points = glb.values<Vector3f>(primitive["attributes"]["POSITION"]);
  ASSERT_EQ(points.size(), 4U);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(points[v], y_up(body.shape.vertices[v]).cast<float>());
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["componentType"], 5123);
  const auto indices = glb.values<std::uint16_t>(primitive["indices"]);
  ASSERT_EQ(indices.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(static_cast<int>(indices[i]), body.shape.triangles[i / 3][static_cast<int>(i % 3)]);
  double volume = 0;  // the outside stays outside
  for (std::size_t i = 0; i < 12; i += 3)
    volume += points[indices[i]].dot(points[indices[i + 1]].cross(points[indices[i + 2]])) / 6;
  EXPECT_NEAR(volume, 1, 1e-6);
}

TEST(Glb, HasLongIndicesWhereShortOnesDoNotReach) {
  GlbMesh body{"body", tetrahedron()};
  body.shape.vertices.resize(65534, Vector3d::Zero());
  const auto component = [&body] {
    const Glb glb(glb_bytes({body}));
    return glb.json["accessors"][glb.json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()].at(
        "componentType");
  };
  EXPECT_EQ(component(), 5123);
  body.shape.vertices.emplace_back(0, 0, 0);
  EXPECT_EQ(component(), 5125);
}

TEST(Glb, AMorphTargetLeadsToTheOtherShape) {
  const GlbMesh body = coloured_body();
  const Glb glb(glb_bytes({body}));
  const auto& mesh = glb.json["meshes"][0];
  EXPECT_EQ(mesh["extras"]["targetNames"], nlohmann::json({"under the garment"}));
  EXPECT_EQ(mesh["weights"].size(), 1U);
  const auto& primitive = mesh["primitives"][0];
  const auto rest = glb.values<Vector3f>(primitive["attributes"]["POSITION"]);
  const auto step = glb.values<Vector3f>(primitive["targets"][0]["POSITION"]);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_NEAR((rest[v] + step[v] - y_up(body.morphs[0].vertices[v]).cast<float>()).norm(), 0, 1e-6);
  const auto normals = glb.values<Vector3f>(primitive["attributes"]["NORMAL"]);
  const auto turns = glb.values<Vector3f>(primitive["targets"][0]["NORMAL"]);
  for (std::size_t v = 0; v < 4; ++v) EXPECT_NEAR((normals[v] + turns[v]).norm(), 1, 1e-5);
}

TEST(Glb, ColoursAreLinearLightAndValuesAreKept) {
  const Glb glb(glb_bytes({coloured_body()}));
  const auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  const auto colours = glb.values<std::array<std::uint16_t, 4>>(attributes["COLOR_0"]);
  EXPECT_EQ(colours[0][0], 65535);
  EXPECT_EQ(colours[0][1], 0);
  EXPECT_NEAR(colours[0][2] / 65535.0, 0.2159, 1e-4);  // sRGB 128
  EXPECT_EQ(glb.values<float>(attributes["_DISTORTION"]), (std::vector<float>{1, 0.5F, 1, 2}));
}

TEST(Glb, SameArgumentsSameBytes) {
  EXPECT_EQ(glb_bytes({coloured_body()}), glb_bytes({coloured_body()}));
}

TEST(Glb, RefusesWhatDoesNotFit) {
  const auto refused = [](const GlbMesh& mesh) -> std::string {
    try {
      glb_bytes({mesh});
      return "";
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
  };
  EXPECT_EQ(refused(coloured_body()), "");
  GlbMesh mesh = coloured_body();
  mesh.colours.pop_back();
  EXPECT_EQ(refused(mesh), "bad_mesh");
  mesh = coloured_body();
  mesh.morphs[0].vertices.pop_back();
  EXPECT_EQ(refused(mesh), "bad_mesh");
  mesh = coloured_body();
  mesh.scalars[0].values[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refused(mesh), "non_finite");
  mesh = coloured_body();
  mesh.shape.triangles.clear();
  EXPECT_EQ(refused(mesh), "bad_mesh");
}

TEST(Tube, IsClosedAndAsLongAsItsLine) {
  std::vector<Vector3d> bent;  // half a circle, 0.5 m long
  for (int i = 0; i <= 60; ++i)
    bent.emplace_back(0, 0.5 / M_PI * std::cos(M_PI * i / 60), 0.5 / M_PI * std::sin(M_PI * i / 60));
  const geometry::TriangleMesh mesh = tube(bent, 0.01, 8);
  EXPECT_TRUE(geometry::is_closed(mesh));
  const double full = 0.5 * M_PI * 1e-4;
  const double volume = geometry::cone_volume(mesh.vertices, mesh.triangles);
  EXPECT_GT(volume, 0.8 * full);  // a tube of 8 sides has 90 % of the round one
  EXPECT_LT(volume, full);
  EXPECT_EQ(tube({bent[0], bent[0]}, 0.01).vertices.size(), 16U);  // points that coincide are no error
}

}  // namespace
}  // namespace tensegric_fit::mesh_files
