#include "mesh_files/glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/status.hpp"
#include "mesh_files/frame.hpp"

namespace tensegric_fit::mesh_files {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Numbers of the glTF 2.0 specification.
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;

// glTF's vertex colours are linear light; sRGB's curve is that of IEC 61966-2-1.
double linear(std::uint8_t value) {
  const double s = value / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::vector<Vector3f> in_gltf(const std::vector<Vector3d>& points) {
  std::vector<Vector3f> result;
  result.reserve(points.size());
  for (const Vector3d& p : points) result.push_back(y_up(p).cast<float>());
  return result;
}

// A normal of length 0 is not valid glTF.
std::vector<Vector3f> normals_of(const std::vector<Vector3d>& points,
                                 const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Vector3d> normals = geometry::vertex_normals(points, triangles);
  for (Vector3d& n : normals)
    if (!(n.norm() > 0.5)) n = Vector3d::UnitZ();
  return in_gltf(normals);
}

std::vector<Vector3f> minus(std::vector<Vector3f> a, const std::vector<Vector3f>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

void check(const GlbMesh& mesh) {
  const auto same = [&](std::size_t count, const std::string& what) {
    if (count != mesh.shape.vertices.size())
      throw geometry::Refusal(geometry::refusal::kBadMesh,
                              mesh.name + ": " + what + " of another number than its vertices");
  };
  geometry::check_mesh(mesh.shape);
  if (mesh.shape.triangles.empty())
    throw geometry::Refusal(geometry::refusal::kBadMesh, mesh.name + ": has no triangles");
  if (!mesh.colours.empty()) same(mesh.colours.size(), "colours");
  for (const GlbScalar& scalar : mesh.scalars) {
    same(scalar.values.size(), scalar.name);
    if (!std::all_of(scalar.values.begin(), scalar.values.end(), [](float v) { return std::isfinite(v); }))
      throw geometry::Refusal(geometry::refusal::kNonFinite,
                              mesh.name + ": " + scalar.name + " is not finite");
  }
  for (const GlbMorph& morph : mesh.morphs) {
    same(morph.vertices.size(), morph.name);
    geometry::check_mesh({morph.vertices, {}});
  }
}

class Writer {
 public:
  explicit Writer(const Json& extras) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "tensegric_fit"}};
    if (!extras.is_null()) root_["asset"]["extras"] = extras;
    root_["scene"] = 0;
    root_["scenes"] = Json::array({Json{{"nodes", Json::array()}}});
  }

  void add(const GlbMesh& mesh) {
    const auto& [vertices, triangles] = mesh.shape;
    const std::vector<Vector3f> points = in_gltf(vertices), normals = normals_of(vertices, triangles);
    Json attributes{{"POSITION", add_positions(points)}, {"NORMAL", add_vectors(normals)}};
    if (!mesh.colours.empty()) attributes["COLOR_0"] = add_colours(mesh.colours);
    for (const GlbScalar& scalar : mesh.scalars)
      attributes[scalar.name] =
          accessor(view(scalar.values, kVertexBuffer), kFloat, "SCALAR", vertices.size());
    Json primitive{{"attributes", std::move(attributes)},
                   {"indices", add_indices(triangles, vertices.size())},
                   {"material", add_material(mesh)}};
    Json names = Json::array(), weights = Json::array();
    for (const GlbMorph& morph : mesh.morphs) {
      primitive["targets"].push_back(
          {{"POSITION", add_positions(minus(in_gltf(morph.vertices), points))},
           {"NORMAL", add_vectors(minus(normals_of(morph.vertices, triangles), normals))}});
      names.push_back(morph.name);
      weights.push_back(0);
    }
    Json entry{{"name", mesh.name}, {"primitives", Json::array({std::move(primitive)})}};
    if (!names.empty()) {
      entry["weights"] = std::move(weights);
      entry["extras"]["targetNames"] = std::move(names);  // as Blender and three.js read them
    }
    root_["meshes"].push_back(std::move(entry));
    Json node{{"name", mesh.name}, {"mesh", root_["meshes"].size() - 1}};
    if (!mesh.extras.is_null()) node["extras"] = mesh.extras;
    root_["nodes"].push_back(std::move(node));
    root_["scenes"][0]["nodes"].push_back(root_["nodes"].size() - 1);
  }

  std::string bytes() {
    if (!data_.empty()) root_["buffers"] = Json::array({Json{{"byteLength", data_.size()}}});
    std::string text = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::uint64_t total = 12 + 8 + text.size() + (data_.empty() ? 0 : 8 + data_.size());
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw geometry::Refusal(geometry::refusal::kBadMesh, "a GLB file holds less than 4 GB");
    std::string file = "glTF";
    const auto number = [&file](std::uint32_t value) {
      file.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    number(2);
    number(static_cast<std::uint32_t>(total));
    number(static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    if (data_.empty()) return file;
    number(static_cast<std::uint32_t>(data_.size()));
    file.append("BIN\0", 4);
    return file + data_;
  }

 private:
  template <typename T>
  std::size_t view(const std::vector<T>& values, int target) {
    const std::size_t length = values.size() * sizeof(T);
    root_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", length}, {"target", target}});
    data_.append(reinterpret_cast<const char*>(values.data()), length);
    data_.resize((data_.size() + 3) / 4 * 4, '\0');
    return root_["bufferViews"].size() - 1;
  }

  std::size_t accessor(std::size_t view, int component, const char* type, std::size_t count) {
    root_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return root_["accessors"].size() - 1;
  }

  std::size_t add_vectors(const std::vector<Vector3f>& vectors) {
    return accessor(view(vectors, kVertexBuffer), kFloat, "VEC3", vectors.size());
  }

  std::size_t add_positions(const std::vector<Vector3f>& points) {
    const std::size_t at = add_vectors(points);
    Vector3f low = points.front(), high = low;
    for (const Vector3f& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    root_["accessors"][at]["min"] = {low.x(), low.y(), low.z()};
    root_["accessors"][at]["max"] = {high.x(), high.y(), high.z()};
    return at;
  }

  std::size_t add_colours(const std::vector<std::array<std::uint8_t, 3>>& colours) {
    constexpr std::uint16_t kFull = 65535;  // 8 bits of linear light would show steps in the dark
    std::vector<std::array<std::uint16_t, 4>> linear_light;
    for (const auto& colour : colours) {
      std::array<std::uint16_t, 4> rgba{0, 0, 0, kFull};
      for (int c = 0; c < 3; ++c)
        rgba[c] = static_cast<std::uint16_t>(std::lround(kFull * linear(colour[c])));
      linear_light.push_back(rgba);
    }
    const std::size_t at =
        accessor(view(linear_light, kVertexBuffer), kUnsignedShort, "VEC4", linear_light.size());
    root_["accessors"][at]["normalized"] = true;
    return at;
  }

  // Short where they fit, as pages hold the file. 65535 is no index: it restarts a strip.
  std::size_t add_indices(const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices) {
    return vertices < std::numeric_limits<std::uint16_t>::max()
               ? add_indices<std::uint16_t>(triangles, kUnsignedShort)
               : add_indices<std::uint32_t>(triangles, kUnsignedInt);
  }

  template <typename Index>
  std::size_t add_indices(const std::vector<Eigen::Vector3i>& triangles, int component) {
    std::vector<Index> indices;
    indices.reserve(3 * triangles.size());
    for (const Eigen::Vector3i& t : triangles)
      for (int c = 0; c < 3; ++c) indices.push_back(static_cast<Index>(t[c]));
    return accessor(view(indices, kIndexBuffer), component, "SCALAR", indices.size());
  }

  std::size_t add_material(const GlbMesh& mesh) {
    const auto& c = mesh.colour;
    root_["materials"].push_back({{"name", mesh.name},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", {linear(c[0]), linear(c[1]), linear(c[2]), 1.0}},
                                    {"metallicFactor", 0},
                                    {"roughnessFactor", 0.8}}}});
    return root_["materials"].size() - 1;
  }

  Json root_;
  std::string data_;
};

}  // namespace

std::string glb_bytes(const std::vector<GlbMesh>& meshes, const nlohmann::json& extras) {
  Writer writer(extras);
  for (const GlbMesh& mesh : meshes) {
    check(mesh);
    writer.add(mesh);
  }
  return writer.bytes();
}

geometry::TriangleMesh tube(const std::vector<Vector3d>& line, double radius, int sides) {
  const int count = static_cast<int>(line.size());
  if (count < 2 || sides < 3)
    throw geometry::Refusal(geometry::refusal::kBadMesh, "a tube needs two points and three sides");
  geometry::TriangleMesh mesh;
  Vector3d along = Vector3d::UnitZ(), out = Vector3d::UnitX();
  for (int i = 0; i < count; ++i) {
    const Vector3d step = line[std::min(i + 1, count - 1)] - line[std::max(i - 1, 0)];
    if (step.norm() > 0) along = step.normalized();
    // The previous ring's direction, made perpendicular: rings do not turn against each other.
    Vector3d side = out - along * along.dot(out);
    if (side.norm() < 1e-3) side = along.unitOrthogonal();
    out = side.normalized();
    const Vector3d up = along.cross(out);
    for (int s = 0; s < sides; ++s) {
      const double angle = 2 * M_PI * s / sides;
      mesh.vertices.push_back(line[i] + radius * (std::cos(angle) * out + std::sin(angle) * up));
    }
  }
  for (int i = 0; i + 1 < count; ++i) {
    for (int s = 0; s < sides; ++s) {
      const int a = i * sides + s, b = i * sides + (s + 1) % sides;
      mesh.triangles.emplace_back(a, b, b + sides);
      mesh.triangles.emplace_back(a, b + sides, a + sides);
    }
  }
  const int last = (count - 1) * sides;
  for (int s = 1; s + 1 < sides; ++s) {
    mesh.triangles.emplace_back(0, s + 1, s);
    mesh.triangles.emplace_back(last, last + s, last + s + 1);
  }
  return mesh;
}

}  // namespace tensegric_fit::mesh_files
