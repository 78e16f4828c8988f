/// Headers on which PCL's reader ends the process, reads or writes beyond its points, or takes all memory.
#include <gtest/gtest.h>
#include <pcl/PolygonMesh.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "geometry/ply.hpp"
#include "geometry/ply_header.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::geometry {
namespace {

const std::string kStart = "ply\nformat ascii 1.0\n",
                  kXyz = "property float x\nproperty float y\nproperty float z\n", kEnd = "end_header\n",
                  kPoints = "0 0 0\n1 0 0\n0 1 0\n", kFace = "3 0 1 2\n",
                  kFaces = "element face 1\nproperty list uchar int vertex_indices\n";

class PlyHeader : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string checked(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      check_ply_header(path_);
    } catch (const Refusal& refusal) {
      return refusal.code();
    }
    return "accepted";
  }
  std::string checked_vertices(const std::string& properties) const {
    return checked(kStart + "element vertex 3\n" + properties + kEnd +
                   "0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n");
  }

  const std::string path_ =
      std::filesystem::temp_directory_path() / ("ply_header_test." + std::to_string(getpid()));
};

// PCL takes the size of its picture for the cloud's.
TEST_F(PlyHeader, ACameraAsMeshLabWritesItIsNoPartOfTheMesh) {
  const std::string camera = "element camera 1\nproperty int viewportx\nproperty int viewporty\n",
                    picture = "640 480\n";
  for (const bool first : {false, true}) {
    std::ofstream(path_, std::ios::binary)
        << kStart + (first ? camera : "") + "element vertex 3\n" + kXyz + kFaces + (first ? "" : camera) +
               kEnd + (first ? picture : "") + kPoints + kFace + (first ? "" : picture);
    const TriangleMesh mesh = read_ply_mesh(path_);
    EXPECT_EQ(mesh.vertices.size(), 3u) << first;
    EXPECT_EQ(mesh.triangles.size(), 1u) << first;
  }
}

// They were left out without a word, and the vertices taken for a scan.
TEST_F(PlyHeader, FacesThatPclDoesNotReadAreRefused) {
  for (const char* faces : {"element face 1\nproperty list uchar ushort vertex_indices\n",
                            "element face 1\nproperty list ushort int vertex_indices\n",
                            "element tristrips 1\nproperty list int int vertex_indices\n"}) {
    std::ofstream(path_, std::ios::binary)
        << kStart + "element vertex 3\n" + kXyz + faces + kEnd + kPoints + kFace;
    pcl::PolygonMesh mesh;
    EXPECT_THROW(read_ply(path_, mesh), Refusal) << faces;
  }
}

TEST_F(PlyHeader, OfUsualFilesIsAcceptedAndPclReadsThem) {
  const std::string colours =
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";
  EXPECT_EQ(checked_vertices(kXyz), "accepted");
  EXPECT_EQ(checked_vertices(kXyz + colours), "accepted");
  for (const char* end : {"\n", "\r\n"}) {
    std::string text = kStart + "comment of a scanner\nobj_info by hand\nelement vertex 3\n" + kXyz + kFaces +
                       kEnd + kPoints + kFace;
    if (std::string(end) == "\r\n")
      for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
        text.insert(at, "\r");
    ASSERT_EQ(checked(text), "accepted");
    const TriangleMesh mesh = read_ply_mesh(path_);
    EXPECT_EQ(mesh.vertices.at(1), Eigen::Vector3d(1, 0, 0));
    EXPECT_EQ(mesh.triangles.size(), 1u);
  }
}

TEST_F(PlyHeader, ColoursInAnotherOrderAreRefused) {
  const auto colour = [](const std::string& name) { return "property uchar " + name + "\n"; };
  for (const std::string& colours :
       {colour("blue") + colour("green") + colour("red"), colour("blue"), colour("alpha"),
        colour("red") + colour("blue"), colour("red") + colour("diffuse_red"),
        colour("red") + colour("green") + colour("blue") + colour("diffuse_blue"),
        colour("red") + "property float w\n" + colour("green") + colour("blue")})
    EXPECT_EQ(checked_vertices(kXyz + colours), refusal::kBrokenFile) << colours;
  EXPECT_EQ(checked_vertices(colour("blue") + kXyz), refusal::kBrokenFile);
}

TEST_F(PlyHeader, ThatPclTakesForSomethingElseIsRefused) {
  const std::string vertices = "element vertex 3\n" + kXyz, body = kEnd + kPoints,
                    list = "property list uchar int q\n";
  ASSERT_EQ(checked(kStart + vertices + body), "accepted");
  for (const std::string& text :
       {kStart + vertices + "end_header_\n" + list + body,
        "ply element vertex 4000000000\n" + kStart.substr(4) + vertices + body,
        kStart + vertices + list + body, kStart + " obj_info x\n" + vertices + body,
        kStart + "\tcomment x\n" + vertices + body,
        "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\ncomment\r_property list uchar int q\r\n" + body,
        "ply\r\nformat ascii 1.0\r\nelement vertex 3\n" + kXyz + body,
        kStart + vertices + "property float x\n" + body, kStart + vertices + vertices + body,
        kStart + vertices + "property half w\n" + body, kStart + "element vertex -3\n" + kXyz + body,
        kStart + "element vertex 3 3\n" + kXyz + body, "ply\nelement vertex 3\n" + kXyz + body,
        "ply\nformat ascii 2.0 x\n" + vertices + body, kStart + "vertex 3\n" + body, kStart + kXyz + body})
    EXPECT_EQ(checked(text), refusal::kBrokenFile) << text;
}

TEST_F(PlyHeader, OfRangeGridsIsRefused) {
  const std::string vertices = "element vertex 1\n" + kXyz;
  EXPECT_EQ(checked(kStart + vertices + "element range_grid 2\nproperty list uchar int vertex_indices\n" +
                    kEnd + "0 0 0\n1 -1\n1 -1\n"),
            refusal::kBrokenFile);
  for (const char* size : {"num_cols", "num_rows"})
    EXPECT_EQ(checked(kStart + "obj_info " + size + " 60000\n" + vertices + kEnd + "0 0 0\n"),
              refusal::kBrokenFile);
}

TEST_F(PlyHeader, MustNotPromiseMoreThanTheFileHas) {
  const std::string binary = "ply\nformat binary_little_endian 1.0\n", bytes(120, 'x');
  EXPECT_EQ(checked(binary + "element vertex 10\n" + kXyz + kEnd + bytes), "accepted");
  EXPECT_EQ(checked(binary + "element vertex 11\n" + kXyz + kEnd + bytes), refusal::kBrokenFile);
  EXPECT_EQ(checked(binary + "element vertex 10\n" + kXyz + "property double w\n" + kEnd + bytes),
            refusal::kBrokenFile);
  EXPECT_EQ(checked(binary + "element vertex 10\n" + kXyz + kFaces + kEnd + bytes), refusal::kBrokenFile);
  EXPECT_EQ(checked(binary + "element vertex 10\n" + kXyz + "element nothing 100\n" + kEnd + bytes),
            refusal::kBrokenFile);
  EXPECT_EQ(checked(kStart + "element vertex 3\n" + kXyz + kEnd + "0 0 0\n0 0 0\n0 0"), refusal::kBrokenFile);
  EXPECT_EQ(checked(kStart + "element vertex 3\n" + kXyz + kEnd + "0 0 0\n0 0 0\n0 0 0"), "accepted")
      << "without a last line's end";
}

TEST_F(PlyHeader, OfAPipeIsRefusedWithoutWaiting) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THROW(check_ply_header(path_), Refusal);
}

}  // namespace
}  // namespace tensegric_fit::geometry
