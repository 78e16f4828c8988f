// Meshes from files: the same shape from every format; odd and hostile files are refused by name.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "geometry/status.hpp"
#include "mesh_files/formats.hpp"
#include "mesh_files/frame.hpp"
#include "mesh_files/glb.hpp"
#include "mesh_files/maker_files.hpp"
#include "mesh_files/read_mesh.hpp"
#include "mesh_files/samples.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using geometry::TriangleMesh;
using nlohmann::json;

TriangleMesh corner() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class MeshFile : public ::testing::Test {
 protected:
  MeshFile() { fs::create_directories(folder_); }
  ~MeshFile() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  std::string refusal_of(const std::string& name, const std::string& bytes) const {
    try {
      read_mesh(write(name, bytes));
    } catch (const geometry::Refusal& refusal) {
      EXPECT_NE(std::string(refusal.what()).find(name), std::string::npos) << refusal.what();
      return refusal.code();
    }
    return "accepted";
  }

  fs::path folder_ = fs::temp_directory_path() / ("tensegric_mesh_files_" + std::to_string(getpid()));
};

std::string number(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// A GLB of the corner whose JSON a test may spoil.
struct WrittenGlb {
  json text;
  std::string data;

  WrittenGlb() {
    const std::string bytes = glb_bytes({{"body", corner()}});
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    text = json::parse(bytes.substr(20, length));
    data = bytes.substr(28 + length);
  }

  std::string bytes() const {
    std::string t = text.dump();
    t.resize((t.size() + 3) / 4 * 4, ' ');
    return "glTF" + number(2) + number(static_cast<std::uint32_t>(28 + t.size() + data.size())) +
           number(static_cast<std::uint32_t>(t.size())) + "JSON" + t +
           number(static_cast<std::uint32_t>(data.size())) + std::string("BIN\0", 4) + data;
  }
};

TEST_F(MeshFile, EveryFormatHasTheShape) {
  const TriangleMesh mesh = corner();
  for (const auto& [name, bytes, unit] : {std::tuple("a.OBJ", obj_text(mesh, "body"), 1e-3),
                                          {"a.stl", stl_bytes(mesh), 1e-3},
                                          {"a.glb", glb_bytes({{"body", mesh}}), 1.0}}) {
    const TriangleMesh read = read_mesh(write(name, bytes));
    ASSERT_EQ(read.vertices.size(), 4U) << name;
    EXPECT_TRUE(geometry::is_closed(read)) << name;
    EXPECT_NEAR(unit * unit * unit * geometry::cone_volume(read.vertices, read.triangles), 1, 1e-6) << name;
    const auto box = geometry::bounding_box(read.vertices);
    EXPECT_NEAR((unit * (box[1] - box[0]) - y_up({1, 2, 3})).norm(), 0, 1e-6) << name;
  }
}

TEST_F(MeshFile, ObjWaysToWriteAFace) {
  const std::string text =
      "mtllib ../../etc/passwd\r\no a\n" + kCorners +
      "v 1 1 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\nusemtl b\nf 1/1/1 2//1 4/1 \\\n 3\nf -4 -3 -1\n";
  const TriangleMesh mesh = read_mesh(write("faces.obj", text));
  EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(mesh.vertices.size(), 4U);
}

TEST_F(MeshFile, AnObjCommentThatEndsInABackslashEndsThere) {
  for (const char* end : {"\n", "\r\n"}) {
    for (const char* word : {" # C:\\scans\\", "mtllib C:\\scans\\"})
      EXPECT_EQ(
          read_mesh(write("path.obj", word + std::string(end) + kCorners + "f 1 2 3\n")).triangles.size(),
          1U);
    const std::string comment = std::string(" # C:\\scans\\") + end;
    const TriangleMesh mesh =
        read_mesh(write("comment.obj", comment + kCorners + "v 1 1 0\n" + comment + "f 1 2 3\nf 2 3 4\n"));
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.vertices.size(), 4U);
  }
}

TEST_F(MeshFile, AMarkOfUtf8BeforeTheFirstWordIsSkipped) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(read_mesh(write("mark.obj", mark + kCorners + "f 1 2 3\n")).triangles.size(), 1U);
  EXPECT_EQ(read_xyz(write("mark.xyz", mark + "1 2 3\n4 5 6\n")),
            (std::vector<Vector3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(read_xyz(write("short.xyz", mark.substr(0, 2))).empty());
}

TEST_F(MeshFile, AsciiStlAndBinaryStlThatSaysSolid) {
  const std::string facet =
      " facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1e0 0 0\n vertex 0 1 0\n endloop\n "
      "endfacet\n";
  EXPECT_EQ(read_mesh(write("a.stl", "solid x\n" + facet + "endsolid x\n")).triangles.size(), 1U);
  std::string one_line = "solid x\n" + facet + "endsolid x\n", returns = one_line;
  std::replace(one_line.begin(), one_line.end(), '\n', ' ');
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  for (const std::string& text : {one_line, returns})
    EXPECT_EQ(read_mesh(write("a.stl", text)).triangles.size(), 1U) << text;
  std::string capitals = "\xef\xbb\xbf  SOLID my vertex facet\n" + facet + "endsolid\n";
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(read_mesh(write("a.stl", capitals)).triangles.size(), 1U);
  std::string binary = stl_bytes(corner());
  binary.replace(0, 5, "solid");
  EXPECT_EQ(read_mesh(write("b.stl", binary)).triangles.size(), 4U);
}

TEST_F(MeshFile, GltfNodesPlaceMeshesAndDataLieInTheFile) {
  WrittenGlb glb;
  glb.text["nodes"][0]["scale"] = {2, 2, -2};  // mirrored: the outside stays outside
  const TriangleMesh mesh = read_mesh(write("a.glb", glb.bytes()));
  EXPECT_NEAR(geometry::cone_volume(mesh.vertices, mesh.triangles), 8, 1e-6);
  json three{
      {"asset", {{"version", "2.0"}}},
      {"buffers",
       {{{"byteLength", 36}, {"uri", "data:a/b;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
      {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
      {"nodes", {{{"mesh", 0}}}}};
  EXPECT_EQ(read_mesh(write("a.gltf", three.dump())).triangles.size(), 1U);
  three["nodes"] = {{{"children", {1}}, {"translation", {0, 0, 5}}},
                    {{"mesh", 0}}};  // and no scene says which is first
  const TriangleMesh nested = read_mesh(write("b.gltf", three.dump()));
  EXPECT_EQ(nested.triangles.size(), 1U);
  EXPECT_EQ(nested.vertices[0].z(), 5);
}

TEST_F(MeshFile, NumbersMayHaveAPlus) {
  EXPECT_EQ(read_mesh(write("a.obj", "v +1 0 0\nv 0 +1e0 0\nv 0 0 +.5\nf 1 2 3\n")).triangles.size(), 1U);
  EXPECT_EQ(read_mesh(write("a.stl",
                            "solid x\nfacet normal 0 0 1\nouter loop\nvertex +1.0e+00 0 0\nvertex 0 +1 0\n"
                            "vertex 0 0 +1\nendloop\nendfacet\nendsolid\n"))
                .triangles.size(),
            1U);
  EXPECT_EQ(refusal_of("b.obj", "v +-1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"), "broken_file");
  EXPECT_EQ(refusal_of("c.obj", "v + 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"), "broken_file");
}

TEST_F(MeshFile, RefusesOddTextFilesByName) {
  EXPECT_EQ(refusal_of("nan.obj", kCorners + "v nan 0 0\nf 1 2 4\n"), "non_finite");
  EXPECT_EQ(refusal_of("inf.obj", kCorners + "v inf 0 0\nf 1 2 4\n"), "non_finite");
  EXPECT_EQ(refusal_of("nofaces.obj", kCorners), "bad_mesh");
  EXPECT_EQ(refusal_of("empty.obj", ""), "bad_mesh");
  EXPECT_EQ(refusal_of("flat.obj", kCorners + "f 1 1 1\n"), "bad_mesh");
  EXPECT_EQ(refusal_of("zero.obj", kCorners + "f 0 1 2\n"), "bad_mesh");
  EXPECT_EQ(refusal_of("negative.obj", kCorners + "f 1 2 -9\n"), "bad_mesh");
  EXPECT_EQ(refusal_of("huge.obj", kCorners + "f 1 2 99999999999999999999\n"), "bad_mesh");
  EXPECT_EQ(refusal_of("words.obj", "v a b c\n"), "broken_file");
  EXPECT_EQ(refusal_of("corner.obj", kCorners + "f 1 2 x\n"), "broken_file");
  EXPECT_EQ(refusal_of("short.obj", "v 0 0\n"), "broken_file");
  EXPECT_EQ(refusal_of("a.dae", ""), "bad_option");
  fs::resize_file(write("two_gb.obj", ""), 2UL << 30);  // sparse
  EXPECT_THROW(read_mesh((folder_ / "two_gb.obj").string()), geometry::Refusal);
  EXPECT_THROW(read_mesh(folder_.string() + "/not_there.obj"), geometry::Refusal);
}

TEST_F(MeshFile, RefusesOddStlByName) {
  const std::string good = stl_bytes(corner());
  EXPECT_EQ(refusal_of("cut.stl", good.substr(0, good.size() - 10)), "broken_file");
  EXPECT_EQ(refusal_of("solid.stl", "solid" + good.substr(5, good.size() - 15)), "broken_file");
  EXPECT_EQ(refusal_of("count.stl", good.substr(0, 80) + number(4000000000U) + good.substr(84)),
            "broken_file");
  EXPECT_EQ(refusal_of("half.stl", "solid x\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"),
            "broken_file");
  EXPECT_EQ(refusal_of("none.stl", "solid x\nendsolid x\n"), "bad_mesh");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string bad = good;
  std::memcpy(&bad[96], &nan, sizeof nan);
  EXPECT_EQ(refusal_of("nan.stl", bad), "non_finite");
}

// As STL has them: each facet with corners of its own, which do not count before they are joined.
TEST(MeshOfAFile, IsRefusedWithMoreJoinedVerticesThanArePlannedFor) {
  const TriangleMesh mesh = corner();
  TriangleMesh facets;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const int v = static_cast<int>(facets.vertices.size());
    for (int k = 0; k < 3; ++k) facets.vertices.push_back(mesh.vertices[t[k]]);
    facets.triangles.emplace_back(v, v + 1, v + 2);
  }
  EXPECT_EQ(checked_and_tidy(facets, "many.stl", 4).vertices.size(), 4U);
  try {
    checked_and_tidy(facets, "many.stl", 3);
    ADD_FAILURE() << "accepted";
  } catch (const geometry::Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "too_many_points");
    EXPECT_EQ(std::string(refusal.what()), "many.stl: has more than 3 vertices or 20 million triangles");
  }
}

// What lies beyond the bounds is not looked at: its first corner is not there. 20 MB, a byte a corner, are
// the smallest that have too many; they are not written to a file.
TEST(MeshOfAFile, HasItsTrianglesOfStripsAndFansCountedBeforeTheyAreRead) {
  const std::size_t corners = kMostTriangles + 3;
  WrittenGlb glb;
  const std::size_t start = glb.data.size();
  glb.data.resize((start + corners + 3) / 4 * 4, '\xFF');
  glb.text["buffers"][0]["byteLength"] = glb.data.size();
  json& primitive = glb.text["meshes"][0]["primitives"][0];
  primitive["indices"] = glb.text["accessors"].size();
  glb.text["accessors"].push_back({{"bufferView", glb.text["bufferViews"].size()},
                                   {"componentType", 5121},
                                   {"count", corners},
                                   {"type", "SCALAR"}});
  glb.text["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", corners}});
  const auto judged = [&](int mode, std::size_t count) -> std::string {
    primitive["mode"] = mode;
    glb.text["accessors"].back()["count"] = count;
    try {
      glb_mesh(glb.bytes(), "long.glb");
    } catch (const geometry::Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  };
  for (const int mode : {5, 6}) {
    EXPECT_EQ(judged(mode, corners), "too_many_points") << mode;
    EXPECT_EQ(judged(mode, corners - 1), "bad_mesh") << mode << ": as many triangles as are planned for";
  }
}

TEST_F(MeshFile, RefusesGlbThatIsShownInAnotherShapeThanItsOwn) {
  GlbMesh own{"body", corner()};
  own.morphs = {{"under the garment", corner().vertices}};
  EXPECT_EQ(refusal_of("own.glb", glb_bytes({own})), "accepted") << "as fit.glb is";
  const auto judged = [&](const json& node, const json& mesh, const json& primitive) {
    WrittenGlb glb;
    glb.text["nodes"][0].update(node);
    glb.text["meshes"][0].update(mesh);
    glb.text["meshes"][0]["primitives"][0].update(primitive);
    return refusal_of("shown.glb", glb.bytes());
  };
  const json none = json::object(), targets{{"targets", {{{"POSITION", 0}}}}}, still{{"weights", {0.0}}},
             moved{{"weights", {0.5}}};
  EXPECT_EQ(judged(none, none, targets), "accepted") << "without weights";
  EXPECT_EQ(judged(none, still, targets), "accepted");
  EXPECT_EQ(judged(none, moved, targets), "broken_file");
  EXPECT_EQ(judged(moved, still, targets), "broken_file") << "the node's weights come before the mesh's";
  EXPECT_EQ(judged(still, moved, targets), "accepted");
  EXPECT_EQ(judged(moved, moved, none), "accepted") << "nothing to weigh";
  const json posed{{"skin", 0}};
  EXPECT_EQ(judged(posed, none, none), "accepted") << "no vertex hangs on it";
  EXPECT_EQ(judged(posed, none, {{"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}}}}), "broken_file");
  EXPECT_EQ(judged(none, none, {{"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}}}}), "accepted");
}

/// The corner on two joints that stand as they were bound, in an armature that doubles it and lifts it by 1.
struct RiggedGlb : WrittenGlb {
  RiggedGlb() {
    const Eigen::Affine3d lower(Eigen::Translation3d(0, 1, 0) *
                                Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
    const Eigen::Affine3d upper = lower * Eigen::Translation3d(0.5, 0, 0);
    const std::size_t start = data.size();
    for (const Eigen::Affine3d& joint : {lower, upper}) {
      const Eigen::Matrix4f inverse = joint.inverse().matrix().cast<float>();
      data.append(reinterpret_cast<const char*>(inverse.data()), sizeof(float) * 16);
    }
    text["buffers"][0]["byteLength"] = data.size();
    const std::size_t view = text["bufferViews"].size(), matrices = text["accessors"].size();
    text["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", 128}});
    text["accessors"].push_back(
        {{"bufferView", view}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
    text["skins"] = json::parse(R"([{"joints": [2, 3]}])");
    text["skins"][0]["inverseBindMatrices"] = matrices;
    text["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 0;
    json& nodes = text["nodes"];
    nodes[0]["skin"] = 0;
    nodes[0]["translation"] = {7, 7, 7};  // does not count
    nodes.push_back(json::parse(R"({"children": [2], "scale": [2, 2, 2], "translation": [0, 0, 1]})"));
    nodes.push_back(json::parse(R"({"children": [3], "translation": [0, 1, 0]})"));
    nodes[2]["rotation"] = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    nodes.push_back(json::parse(R"({"translation": [0.5, 0, 0]})"));
    text["scenes"][0]["nodes"] = json::parse("[0, 1]");
  }
};

TEST_F(MeshFile, GlbOnASkeletonThatStandsAsItWasBoundIsWhereItsJointsPutIt) {
  const TriangleMesh plain = read_mesh(write("plain.glb", WrittenGlb().bytes()));
  const auto expect_at = [&](const RiggedGlb& glb, const Vector3d& shift) {
    const TriangleMesh mesh = read_mesh(write("rigged.glb", glb.bytes()));
    ASSERT_EQ(mesh.vertices.size(), plain.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      EXPECT_NEAR((mesh.vertices[v] - (2.0 * plain.vertices[v] + shift)).norm(), 0, 1e-5) << v;
  };
  expect_at({}, {0, 0, 1});
  RiggedGlb raised;
  raised.text["nodes"][2]["translation"] = {0, 2, 0};  // and all that hangs on it
  expect_at(raised, {0, 2, 1});
}

TEST_F(MeshFile, RefusesGlbThatASkeletonPoses) {
  const auto judged = [&](const char* pointer, const json& value) {
    RiggedGlb glb;
    glb.text[json::json_pointer(pointer)] = value;
    return refusal_of("posed.glb", glb.bytes());
  };
  EXPECT_EQ(judged("/nodes/3/name", "hand"), "accepted");
  EXPECT_EQ(judged("/nodes/3/translation", json::array({0.5, 0, 0.0001})), "broken_file");
  EXPECT_EQ(judged("/nodes/3/rotation", json::array({0.1, 0, 0, 0.995})), "broken_file");
  EXPECT_EQ(judged("/nodes/3/translation", json::array({1e308, 0, 0})), "broken_file");
  EXPECT_EQ(judged("/skins/0/joints", json::array()), "broken_file");
  EXPECT_EQ(judged("/skins/0/joints", json::array({2, 99})), "broken_file");
  EXPECT_EQ(judged("/skins/0/joints", json::array({2, 3, 3})), "broken_file") << "two matrices";
  EXPECT_EQ(judged("/nodes/3/children", json::array({2})), "broken_file") << "each other's child";
  RiggedGlb bare;
  bare.text["skins"][0].erase("inverseBindMatrices");
  EXPECT_EQ(refusal_of("bare.glb", bare.bytes()), "broken_file");
  bare.text["skins"][0]["joints"] = json::array({3});
  EXPECT_EQ(refusal_of("bare.glb", bare.bytes()), "accepted") << "no matrix is the identity";
}

TEST_F(MeshFile, RefusesGlbThatLies) {
  const WrittenGlb good;
  const std::string bytes = good.bytes();
  EXPECT_EQ(refusal_of("good.glb", bytes), "accepted");
  EXPECT_EQ(refusal_of("cut.glb", bytes.substr(0, bytes.size() - 8)), "broken_file");
  EXPECT_EQ(refusal_of("length.glb", bytes.substr(0, 8) + number(3000000000U) + bytes.substr(12)),
            "broken_file");
  EXPECT_EQ(refusal_of("text.glb", bytes.substr(0, 12) + number(3000000000U) + bytes.substr(16)),
            "broken_file");
  EXPECT_EQ(refusal_of("deep.gltf", std::string(100000, '[')), "broken_file");
  const auto spoilt = [&](const char* pointer, const json& value) {
    WrittenGlb glb;
    glb.text[json::json_pointer(pointer)] = value;
    return refusal_of("spoilt.glb", glb.bytes());
  };
  EXPECT_EQ(spoilt("/accessors/0/count", 4000000000U), "broken_file");
  EXPECT_EQ(spoilt("/accessors/0/count", std::uint64_t{1} << 63), "broken_file");
  EXPECT_EQ(spoilt("/accessors/0/count", -5), "broken_file");
  EXPECT_EQ(spoilt("/accessors/0/type", 5), "broken_file");
  EXPECT_EQ(spoilt("/accessors/0/byteOffset", 4000000000U), "broken_file");
  EXPECT_EQ(spoilt("/bufferViews/0/byteOffset", 4000000000U), "broken_file");
  EXPECT_EQ(spoilt("/bufferViews/0/byteStride", 0), "broken_file");
  EXPECT_EQ(spoilt("/meshes/0/primitives/0/attributes/POSITION", 77), "broken_file");
  EXPECT_EQ(spoilt("/nodes/0/children", json::array({0, 0})), "broken_file");
  EXPECT_EQ(spoilt("/nodes/0/matrix", json::array({1, 2})), "broken_file");
  EXPECT_EQ(spoilt("/extensionsRequired", json::array({"KHR_draco_mesh_compression"})), "broken_file");
  EXPECT_EQ(spoilt("/scene", 9), "broken_file");
  WrittenGlb index;
  const std::size_t start = index.text["bufferViews"].back()["byteOffset"];
  index.data.replace(start, 4, number(4000000000U));
  EXPECT_EQ(refusal_of("index.glb", index.bytes()), "bad_mesh");
}

TEST_F(MeshFile, OpensNothingElse) {
  // The other file is there, and whole: it is refused all the same.
  WrittenGlb glb;
  write("other.bin", glb.data);
  glb.text["buffers"][0]["uri"] = "other.bin";
  try {
    read_mesh(write("outside.glb", glb.bytes()));
    FAIL();
  } catch (const geometry::Refusal& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("other.bin"), std::string::npos);
  }
  WrittenGlb textured;
  textured.text["images"] = json::array({{{"uri", "/not/there.png"}}});
  EXPECT_EQ(refusal_of("textured.glb", textured.bytes()), "accepted");
}

TEST_F(MeshFile, XyzHasHeadingsAndFurtherColumns) {
  const auto points = read_xyz(write("a.xyz", "x y z r\n1 2 3 255\r\n\n4,5;6\n"));
  EXPECT_EQ(points, (std::vector<Vector3d>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_THROW(read_xyz(write("b.xyz", "1 2 3\n4 5\n")), geometry::Refusal);
  EXPECT_EQ(read_xyz(write("c.xyz", "# a scan\n//X Y Z\n2\n1 2 3\n1,2,3 7\n")).size(), 2U);
  EXPECT_THROW(read_xyz(write("d.xyz", "a\nb\n")), geometry::Refusal);
  EXPECT_EQ(read_xyz(write("f.xyz", "x,mm y,mm z,mm\n1 2 3\n")).size(), 1U);
  EXPECT_THROW(read_xyz(write("g.xyz", "1 2\n3 4\n1 2 3\n")), geometry::Refusal);
  EXPECT_THROW(read_xyz(write("e.xyz", "0,12 0,5 1,7\n")), geometry::Refusal);  // a comma for the point
}

TEST(SurfaceSamples, AreEvenAndHaveNormalsWhereTheMeshHasAnOutside) {
  TriangleMesh mesh = corner();
  const geometry::PointCloud cloud = surface_samples(mesh, 10000);
  ASSERT_EQ(cloud.points.size(), 10000U);
  int on_floor = 0;
  for (std::size_t i = 1; i < cloud.points.size(); ++i) {  // the first lies on an edge
    if (cloud.points[i].z() > 0) continue;
    ++on_floor;
    EXPECT_NEAR(cloud.normals[i].z(), -1, 1e-9);
  }
  EXPECT_NEAR(on_floor / 10000.0, 1 / (1 + 1.5 + 3 + 3.5), 1e-3);  // by area
  for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(surface_samples(mesh, 100).normals.size(), 100U);  // all reversed: known from the volume
  const geometry::PointCloud reversed = surface_samples(mesh, 100);
  for (std::size_t i = 1; i < 100; ++i)
    if (reversed.points[i].z() == 0) {
      EXPECT_NEAR(reversed.normals[i].z(), -1, 1e-9);
    }
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  mesh.triangles.push_back(mesh.triangles[1]);  // one runs against its neighbours, one is there twice
  const geometry::PointCloud mended = surface_samples(mesh, 100);
  ASSERT_EQ(mended.normals.size(), reversed.normals.size());
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(mended.normals[i].dot(reversed.normals[i]), 1, 1e-9);
}

TEST(SurfaceSamples, DoNotDependOnTheOrderOfTriangles) {
  geometry::TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.2}, {0.2, 0.3, 1}},
                              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const geometry::PointCloud before = surface_samples(mesh, 1000);
  std::swap(mesh.triangles[0], mesh.triangles[3]);
  mesh.triangles[1] = {3, 0, 1};
  EXPECT_EQ(surface_samples(mesh, 1000).points, before.points);
}

TEST(SurfaceSamples, HaveNoNormalsWhereTheMeshHasNoOutside) {
  TriangleMesh mesh = corner(), soup;
  for (const Eigen::Vector3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) soup.vertices.push_back(mesh.vertices[t[k]]);
  for (int f = 0; f < 4; ++f) soup.triangles.emplace_back(3 * f, 3 * f + 1, 3 * f + 2);
  EXPECT_TRUE(surface_samples(soup, 100).normals.empty()) << "no triangle has a neighbour";
  TriangleMesh strip;  // Moebius: a band with half a turn
  constexpr int kAround = 40;
  for (int i = 0; i < kAround; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double angle = 2 * M_PI * i / kAround;
      const Vector3d out(std::cos(angle), std::sin(angle), 0);
      strip.vertices.emplace_back(
          out + side * (std::cos(angle / 2) * out + std::sin(angle / 2) * Vector3d::UnitZ()));
    }
  for (int i = 0; i < kAround; ++i) {
    const bool last = i + 1 == kAround;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.emplace_back(a, b, d);
    strip.triangles.emplace_back(a, d, c);
  }
  EXPECT_TRUE(surface_samples(strip, 100).normals.empty());
}

}  // namespace
}  // namespace tensegric_fit::mesh_files
