// The body model's files: the shipped ones fit their program, and broken ones are refused by name.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "body_model/model.hpp"
#include "body_model/standing.hpp"
#include "geometry/shipped_files.hpp"
#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::body_model {
namespace {

using Json = nlohmann::json;

std::string shipped(const std::string& name) {
  return geometry::shipped_folder("body_model") + "/" + name;
}

const Model& model() {
  static const Model shipped_model = load_model(shipped("women.tfb"));
  return shipped_model;
}

/// A model file in its three pieces.
struct File {
  std::string magic;
  Json header;
  std::string arrays;

  std::string text() const {
    const std::string head = header.dump();
    return magic + "\n" + std::to_string(head.size()) + "\n" + head + arrays;
  }
  /// Bytes of an array before it, and of the array.
  std::pair<std::size_t, std::size_t> place_of(const std::string& name) const {
    std::size_t at = 0;
    for (const Json& array : header["arrays"]) {
      const std::string type = array["type"];
      std::size_t size = type == "float32" ? 4 : type == "uint16" || type == "int16" ? 2 : 1;
      for (const std::size_t extent : array["shape"]) size *= extent;
      if (array["name"] == name) return {at, size};
      at += size;
    }
    ADD_FAILURE() << "no array " << name;
    return {0, 0};
  }
  Json& array(const std::string& name) {
    for (Json& found : header["arrays"])
      if (found["name"] == name) return found;
    throw std::out_of_range(name);
  }
  template <typename Type>
  void set(const std::string& name, std::size_t index, Type value) {
    std::memcpy(&arrays[place_of(name).first + index * sizeof(Type)], &value, sizeof(Type));
  }
};

const File& sound() {
  static const File file = [] {
    std::ifstream stream(shipped("women.tfb"), std::ios::binary);
    File read;
    std::string length;
    std::getline(stream, read.magic);
    std::getline(stream, length);
    std::string head(std::stoul(length), ' ');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    read.header = Json::parse(head);
    std::ostringstream rest;
    rest << stream.rdbuf();
    read.arrays = rest.str();
    return read;
  }();
  return file;
}

class ModelFile : public testing::Test {
 protected:
  void SetUp() override { path_ = testing::TempDir() + "model_" + std::to_string(getpid()); }
  void TearDown() override { std::filesystem::remove(path_); }

  /// The refusal of a file with this text, or "".
  std::string refusal_of(
      const std::string& text, const std::function<void(const std::string&)>& load =
                                   [](const std::string& path) { load_model(path); }) const {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      load(path_);
      return "";
    } catch (const geometry::Refusal& refusal) {
      EXPECT_EQ(refusal.code(), geometry::refusal::kBrokenFile);
      EXPECT_NE(std::string(refusal.what()).find(path_), std::string::npos) << refusal.what();
      return refusal.what();
    }
  }
  void expect_refused(const std::function<void(File&)>& change, const std::string& word) const {
    File file = sound();
    change(file);
    const std::string refusal = refusal_of(file.text());
    EXPECT_NE(refusal.find(word), std::string::npos) << "'" << refusal << "' does not say '" << word << "'";
  }
  std::string path_;
};

TEST_F(ModelFile, TheShippedOneFitsItself) {
  const std::size_t vertices = model().mean.size();
  EXPECT_EQ(refusal_of(sound().text()), "");
  EXPECT_LE(std::filesystem::file_size(shipped("women.tfb")), 4u << 20);
  EXPECT_EQ(model().checksum.size(), 16u);
  EXPECT_EQ(model().basis.cols(), static_cast<Eigen::Index>(3 * vertices));
  EXPECT_EQ(model().triangles.size(), 2 * model().quads.size());
  const geometry::TriangleMesh mesh{model().mean, model().triangles};
  EXPECT_TRUE(geometry::is_closed(mesh));
  EXPECT_GT(geometry::cone_volume(mesh.vertices, mesh.triangles), 0.03);  // outward, and of a person
  for (std::size_t v = 0; v < vertices; ++v) {
    double sum = 0;
    for (const float w : model().weights[v]) sum += w;
    EXPECT_NEAR(sum, 1, 1e-6) << "vertex " << v;
  }
  for (const SkinPoint& point : model().skin_points) {
    double sum = 0;
    for (const auto& share : point.vertices) sum += share.second;
    EXPECT_NEAR(sum, 1, 1e-12) << point.name;  // scans may be far from their origin
  }
  for (const char* part : {"head", "neck", "trunk", "breast_L", "breast_R", "upper_arm_L", "thigh_R"})
    EXPECT_GE(model().part_named(part), 0) << part;
  for (const char* group : {"arm_L", "arm_R", "thigh_L"}) EXPECT_GE(model().group_named(group), 0) << group;
  EXPECT_EQ(model().part_named("tail"), -1);
  EXPECT_EQ(model().group_named("tail"), -1);
  // She faces -y, her left at +x.
  const auto point = [](const std::string& name) {
    for (const SkinPoint& p : model().skin_points)
      if (p.name == name) return model().mean[p.vertices.front().first];
    throw std::out_of_range(name);
  };
  EXPECT_GT(point("bust_point_L").x(), 0.05);
  EXPECT_LT(point("bust_point_R").x(), -0.05);
  EXPECT_LT(point("neck_front").y(), point("neck_back").y());
}

TEST_F(ModelFile, ItsChecksumChangesWithEveryByte) {
  File other = sound();
  other.arrays[other.arrays.size() / 2] = static_cast<char>(other.arrays[other.arrays.size() / 2] ^ 1);
  ASSERT_EQ(refusal_of(other.text()), "");
  EXPECT_NE(load_model(path_).checksum, model().checksum);
}

TEST_F(ModelFile, ATruncatedOneIsRefusedWhereverItEnds) {
  const std::string text = sound().text();
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, std::size_t{27}, std::size_t{31},
                                   std::size_t{200}, std::size_t{5000}, text.size() / 2, text.size() - 1})
    EXPECT_NE(refusal_of(text.substr(0, length)), "") << length;
  EXPECT_NE(refusal_of(text + "x").find("after the last array"), std::string::npos);
  EXPECT_THROW(load_model(path_ + ".none"), geometry::Refusal);
}

TEST_F(ModelFile, AnotherFormatIsRefused) {
  expect_refused([](File& f) { f.magic = "tensegric_fit body model 2"; }, "not a body model of this format");
  expect_refused([](File& f) { f.magic = "ply"; }, "not a body model of this format");
  const std::string rest = sound().arrays;
  for (const char* length : {"", "-1", "9999999", "99999999999999999999", "12x", "0x10"})
    EXPECT_NE(refusal_of(sound().magic + "\n" + length + "\n{}" + rest).find("length of the header"),
              std::string::npos)
        << length;
  EXPECT_NE(refusal_of(sound().magic + "\n2\n{}"), "");
  EXPECT_NE(refusal_of(sound().magic + "\n2\n[]"), "");
  EXPECT_NE(refusal_of(sound().magic + "\n2\n{["), "");
}

TEST_F(ModelFile, WhatDoesNotFitTogetherIsRefusedByName) {
  for (const char* key : {"stature", "bones", "groups", "parts", "skin_points", "bone_points", "arrays"})
    expect_refused([key](File& f) { f.header.erase(key); }, key);
  expect_refused([](File& f) { f.header["bones"] = Json::array(); }, "bone");
  expect_refused([](File& f) { f.header["bones"][3]["parent"] = 7; }, "parent");
  expect_refused([](File& f) { f.header["bones"][3]["parent"] = -1; }, "parent");
  expect_refused([](File& f) { f.header["groups"][0]["bones"][0][0] = 26; }, "group's bone");
  expect_refused([](File& f) { f.header["groups"][0]["spread"] = {0.1, 0.1}; }, "spread");
  expect_refused([](File& f) { f.header["groups"][0]["spread"] = {0.1, 0.1, 0}; }, "spread");
  expect_refused([](File& f) { f.header["bone_points"][0]["bone"] = 26; }, "bone point");
  expect_refused([](File& f) { f.header["skin_points"][0]["vertices"][0][0] = 13380; }, "skin point");
  expect_refused([](File& f) { f.header["skin_points"][0]["vertices"][0][0] = -1; }, "skin point");
  expect_refused([](File& f) { f.header["skin_points"][0]["vertices"] = Json::array(); }, "skin point");
  expect_refused([](File& f) { f.header["stature"] = "tall"; }, "");
  for (const double stature : {0.0, -1.7, 170.0})
    expect_refused([=](File& f) { f.header["stature"] = stature; }, "stature");
}

TEST_F(ModelFile, NamesThatOtherCodeAsksForAreNeeded) {
  const auto renamed = [](const char* list, const char* name) {
    return [=](File& f) {
      for (Json& entry : f.header[list])
        if (entry.is_string() ? entry == name : entry["name"] == name)
          (entry.is_string() ? entry : entry["name"]) = "other";
    };
  };
  for (const auto& [list, name] :
       std::vector<std::pair<const char*, const char*>>{{"bones", "foot.L"},
                                                        {"groups", "arm_R"},
                                                        {"parts", "trunk"},
                                                        {"skin_points", "crotch"},
                                                        {"skin_points", "neck_ring_L"},
                                                        {"bone_points", "acromion_R"}})
    expect_refused(renamed(list, name), name);
}

TEST_F(ModelFile, ArraysOfAnotherSizeOrTypeAreRefused) {
  expect_refused([](File& f) { f.array("mean")["name"] = "means"; }, "'mean'");
  expect_refused([](File& f) { f.array("mean")["type"] = "float64"; }, "type");
  expect_refused([](File& f) { f.array("mean")["shape"] = {13380 * 3}; }, "'mean'");
  expect_refused([](File& f) { f.array("quads")["shape"] = {13378 * 2, 2}; }, "'quads'");
  expect_refused([](File& f) { f.array("extra_mean")["shape"] = {27, 3}; }, "");
  expect_refused([](File& f) { f.array("mean")["shape"] = {1000000000, 1000000000}; }, "too large");
  expect_refused([](File& f) { f.array("mean")["shape"] = {-1, 3}; }, "too large");
  expect_refused([](File& f) { f.array("step")["shape"] = {0}; }, "");
}

TEST_F(ModelFile, NumbersOutOfTheirRangeAreRefused) {
  expect_refused([](File& f) { f.set("mean", 5, std::nanf("")); }, "'mean'");
  expect_refused([](File& f) { f.set("basis", 0, std::int8_t{1}), f.set("step", 0, INFINITY); }, "'step'");
  expect_refused([](File& f) { f.set("quads", 100, std::uint16_t{13380}); }, "quad");
  expect_refused([](File& f) { f.set("bones", 10, std::uint8_t{26}); }, "bone");
  expect_refused([](File& f) { f.set("parts", 10, std::uint8_t{17}); }, "part");
  expect_refused([](File& f) { f.set("fit_points", 10, std::uint16_t{13380}); }, "fit point");
  // Indices below nought, in arrays that a file calls signed.
  const auto negative = [](const char* name, const char* type) {
    return [=](File& f) {
      f.array(name)["type"] = type;
      std::memset(&f.arrays[f.place_of(name).first], 0xff, 2);
    };
  };
  expect_refused(negative("quads", "int16"), "quad");
  expect_refused(negative("fit_points", "int16"), "fit point");
  expect_refused(negative("bones", "int8"), "bone");
  expect_refused(negative("parts", "int8"), "part");
}

TEST_F(ModelFile, HowWomenStandIsCheckedToo) {
  const auto load = [](const std::string& path) { load_standing(path); };
  std::ifstream stream(shipped("standing.yaml"));
  std::ostringstream text;
  text << stream.rdbuf();
  ASSERT_EQ(refusal_of(text.str(), load), "");
  const auto refusal = [&](const std::string& what, const std::string& by) {
    std::string changed = text.str();
    const std::size_t at = changed.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return refusal_of(changed.replace(at, what.size(), by), load);
  };
  EXPECT_NE(refusal("sideways:", "aside:").find("aside"), std::string::npos);
  EXPECT_NE(refusal("seen:", "seen: 0.5 #").find("seen"), std::string::npos);
  EXPECT_NE(refusal("forwards:", "forwards: 40 #").find("forwards"), std::string::npos);
  EXPECT_NE(refusal("sideways:", "sideways: 0 #").find("sideways"), std::string::npos);  // it is divided by
  EXPECT_NE(refusal("soles:", "soles: .nan #").find("soles"), std::string::npos);
  EXPECT_NE(refusal_of("", load), "");
}

}  // namespace
}  // namespace tensegric_fit::body_model
