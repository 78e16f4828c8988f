// GLB and glTF 2.0: positions and indices of the scene's meshes. Every length is checked against the bytes
// that are there.
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string_view>

#include "geometry/json_text.hpp"
#include "geometry/status.hpp"
#include "mesh_files/formats.hpp"

namespace tensegric_fit::mesh_files {
namespace {

namespace refusal = geometry::refusal;
using geometry::Refusal;
using Json = nlohmann::json;

// Numbers of the glTF 2.0 specification.
constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;
constexpr int kTriangles = 4, kStrip = 5, kFan = 6;
constexpr std::size_t kMostJson = 64UL << 20;  // bytes; parsed, it takes ten times as much
constexpr int kDeepest = 64;                   // levels of nodes; real files have a dozen
constexpr double kAlike =
    1e-5;  // of the size of places that are one: float32 has 6e-8, and joints stand in rows
constexpr std::size_t kMatrix = 64;  // bytes of a MAT4 of float32

std::string from_base64(std::string_view text, const std::string& path) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    if (c == '=') break;
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos)
      throw Refusal(refusal::kBrokenFile, path + ": a buffer of this glTF is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view chunk, const std::string& path) : path_(path) {
    if (text.size() > kMostJson)
      throw Refusal(refusal::kTooManyPoints, path + ": has more than 64 MB of JSON; save it as GLB");
    root_ = geometry::json_in<Json>(text);
    if (!root_.is_object()) throw broken("its JSON cannot be read, or is nested too deeply");
    for (const Json& extension : array("extensionsRequired"))
      if (extension != "KHR_materials_unlit" && extension != "KHR_texture_transform")
        throw broken("needs " + extension.dump(-1, ' ', true, Json::error_handler_t::replace).substr(0, 60) +
                     ", such as compression: save it without");
    for (const Json& buffer : array("buffers")) load(buffer, chunk);
  }

  geometry::TriangleMesh mesh() {
    const Json& scenes = array("scenes");
    if (scenes.empty()) {  // whatever is nobody's child
      std::vector<char> is_child(array("nodes").size(), 0);
      for (const Json& node : array("nodes"))
        for (const Json& child : list(node, "children"))
          if (const std::size_t n = index(child); n < is_child.size()) is_child[n] = 1;
      for (std::size_t n = 0; n < is_child.size(); ++n)
        if (!is_child[n]) add_node(n, Eigen::Affine3d::Identity(), 0);
    } else {
      const Json& scene = at(scenes, root_.contains("scene") ? number(root_, "scene") : 0);
      for (const Json& node : list(scene, "nodes")) add_node(index(node), Eigen::Affine3d::Identity(), 0);
    }
    return std::move(mesh_);
  }

 private:
  Refusal broken(const std::string& what) const { return {refusal::kBrokenFile, path_ + ": " + what}; }

  // Of an object; empty where it is not there.
  const Json& list(const Json& object, const char* name) const {
    static const Json kNone = Json::array();
    if (!object.is_object()) throw broken("its JSON is not glTF");
    const auto found = object.find(name);
    if (found == object.end()) return kNone;
    if (!found->is_array()) throw broken(std::string("'") + name + "' is no list");
    return *found;
  }
  const Json& array(const char* name) const { return list(root_, name); }

  std::size_t index(const Json& value) const {
    if (!value.is_number_unsigned()) throw broken("has an index that is not a whole number or is negative");
    return value.get<std::size_t>();
  }

  std::size_t number(const Json& object, const char* name, std::optional<std::size_t> otherwise = {}) const {
    const auto found = object.is_object() ? object.find(name) : object.end();
    if (!object.is_object() || (found == object.end() && !otherwise))
      throw broken(std::string("lacks '") + name + "'");
    return found == object.end() ? *otherwise : index(*found);
  }

  const Json& at(const Json& items, std::size_t i) const {
    if (i >= items.size()) throw broken("refers to what is not there");
    return items[i];
  }

  void load(const Json& buffer, std::string_view chunk) {
    const std::size_t length = number(buffer, "byteLength");
    std::string_view bytes = chunk;
    if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
      const std::string text = uri->is_string() ? uri->get<std::string>() : "";
      const std::size_t comma = text.find(";base64,");
      if (text.compare(0, 5, "data:") != 0 || comma == std::string::npos)
        throw broken("its points are in another file, '" + text.substr(0, 80) +
                     "', which is not opened: save it as one GLB");
      decoded_.push_back(
          std::make_unique<std::string>(from_base64(std::string_view(text).substr(comma + 8), path_)));
      bytes = *decoded_.back();
    }
    if (length > bytes.size()) throw broken("a buffer is shorter than it says");
    buffers_.push_back(bytes.substr(0, length));
  }

  struct Accessor {
    const char* first;
    std::size_t count, stride;
    int component;
  };

  Accessor accessor(std::size_t i, const std::string& type) const {
    const Json& entry = at(array("accessors"), i);
    if (entry.contains("sparse") || !entry.contains("bufferView"))
      throw broken("has a sparse or compressed accessor: save it without");
    if (entry.value("type", "") != type) throw broken("has an accessor that is no " + type);
    const Json& view = at(array("bufferViews"), number(entry, "bufferView"));
    const std::size_t b = number(view, "buffer");
    if (b >= buffers_.size()) throw broken("refers to what is not there");
    Accessor found{};
    found.component = static_cast<int>(number(entry, "componentType"));
    found.count = number(entry, "count");
    const std::size_t item = type == "MAT4"              ? kMatrix
                             : type == "VEC3"            ? 12
                             : found.component == kByte  ? 1
                             : found.component == kShort ? 2
                                                         : 4;
    found.stride = number(view, "byteStride", item);
    const std::size_t start = number(view, "byteOffset", 0), length = number(view, "byteLength"),
                      offset = number(entry, "byteOffset", 0), size = buffers_[b].size();
    const bool fits = start <= size && length <= size - start && offset <= length && found.stride >= item &&
                      found.stride <= 252 &&
                      (found.count == 0 || (item <= length - offset &&
                                            found.count - 1 <= (length - offset - item) / found.stride));
    if (!fits) throw broken("an accessor reaches beyond its buffer");
    found.first = buffers_[b].data() + start + offset;
    return found;
  }

  Eigen::Affine3d placed(const Json& node) const {
    const auto numbers = [&](const char* name, std::size_t count) {
      const Json& values = list(node, name);
      std::vector<double> result;
      for (const Json& value : values) {
        if (!value.is_number()) throw broken("a node's place is no number");
        result.push_back(value.get<double>());
      }
      if (!result.empty() && result.size() != count) throw broken("a node's place has missing numbers");
      return result;
    };
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    if (const auto m = numbers("matrix", 16); !m.empty())
      place.matrix() = Eigen::Map<const Eigen::Matrix4d>(m.data());
    if (const auto t = numbers("translation", 3); !t.empty())
      place.translate(Eigen::Vector3d(t[0], t[1], t[2]));
    if (const auto q = numbers("rotation", 4); !q.empty())
      place.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
    if (const auto s = numbers("scale", 3); !s.empty()) place.scale(Eigen::Vector3d(s[0], s[1], s[2]));
    return place;
  }

  void add_node(std::size_t i, const Eigen::Affine3d& parent, int depth) {
    if (depth > kDeepest || ++visits_ > kMostVisits)
      throw broken("its nodes contain each other or are too many");
    const Json& node = at(array("nodes"), i);
    const Eigen::Affine3d place = parent * placed(node);
    if (node.contains("mesh") && !is_mark(node)) {
      const Json& shape = at(array("meshes"), number(node, "mesh"));
      for (const Json& primitive : list(shape, "primitives")) {
        check_is_shown(node, shape, primitive);
        add_primitive(primitive, hangs_on_skin(node, primitive) ? bound(number(node, "skin")) : place);
      }
    }
    for (const Json& child : list(node, "children")) add_node(index(child), place, depth + 1);
  }

  // What this product's own files draw beside the body, such as the garment's lines.
  static bool is_mark(const Json& node) {
    const auto extras = node.find("extras");
    return extras != node.end() && extras->is_object() && extras->value("surface", Json(true)) == Json(false);
  }

  static bool hangs_on_skin(const Json& node, const Json& primitive) {
    const auto attributes = primitive.find("attributes");
    return node.contains("skin") && attributes != primitive.end() && attributes->contains("JOINTS_0");
  }

  // Where a skin puts what hangs on it while its joints stand as they were bound: all move it alike, and
  // where its own node stands does not matter. Otherwise it is another shape, which only renderers work out.
  const Eigen::Affine3d& bound(std::size_t i) {
    if (const auto known = bound_.find(i); known != bound_.end()) return known->second;
    const Json& skin = at(array("skins"), i);
    const Json& joints = list(skin, "joints");
    const bool has_inverses = skin.contains("inverseBindMatrices");  // else they are the identity
    Accessor inverses{};
    if (has_inverses) inverses = accessor(number(skin, "inverseBindMatrices"), "MAT4");
    if (has_inverses && (inverses.component != kFloat || inverses.count < joints.size()))
      throw broken("a skin has matrices that are missing or not float32");
    Eigen::Affine3d first = Eigen::Affine3d::Identity();
    double reach = 0, turned = 0, shifted = 0;  // of joints; the most that two places differ by
    bool alike = !joints.empty();
    for (std::size_t j = 0; j < joints.size() && alike; ++j) {
      const Eigen::Affine3d& joint = in_world(index(joints[j]), 0);
      Eigen::Affine3d place = joint;
      if (has_inverses) {
        Eigen::Matrix4f numbers;
        std::memcpy(numbers.data(), inverses.first + j * inverses.stride, kMatrix);
        Eigen::Affine3d inverse = Eigen::Affine3d::Identity();
        inverse.matrix() = numbers.cast<double>();
        place = joint * inverse;
      }
      if (j == 0) first = place;
      alike = place.matrix().allFinite();
      reach = std::max({reach, joint.translation().norm(), place.translation().norm()});
      turned = std::max(turned, (place.linear() - first.linear()).norm());
      shifted = std::max(shifted, (place.translation() - first.translation()).norm());
    }
    if (!alike || turned > kAlike * first.linear().norm() || shifted > kAlike * reach)
      throw broken("is posed by a skeleton: save the posed shape itself");
    return bound_.emplace(i, first).first->second;
  }

  const Eigen::Affine3d& in_world(std::size_t i, int depth) {
    if (const auto known = worlds_.find(i); known != worlds_.end()) return known->second;
    if (depth > kDeepest || ++visits_ > kMostVisits)
      throw broken("its nodes contain each other or are too many");
    const Json& nodes = array("nodes");
    Eigen::Affine3d place = placed(at(nodes, i));
    if (parents_.empty()) find_parents(nodes);
    if (parents_[i] < nodes.size()) place = in_world(parents_[i], depth + 1) * place;
    return worlds_.emplace(i, place).first->second;
  }

  void find_parents(const Json& nodes) {
    parents_.assign(nodes.size(), nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (const Json& child : list(nodes[n], "children")) {
        const std::size_t c = index(child);
        at(nodes, c);
        if (parents_[c] < nodes.size()) throw broken("a node of it is the child of two");
        parents_[c] = n;
      }
  }

  // Weights make another shape of the saved one, and only renderers work out which.
  void check_is_shown(const Json& node, const Json& shape, const Json& primitive) const {
    const Json& own = list(node, "weights");
    const Json& weights = own.empty() ? list(shape, "weights") : own;
    const auto has_effect = [](const Json& weight) { return weight != Json(0); };
    if (primitive.contains("targets") && std::any_of(weights.begin(), weights.end(), has_effect))
      throw broken("is shaped by morph targets: save the shape itself");
  }

  void add_primitive(const Json& primitive, const Eigen::Affine3d& place) {
    const std::size_t mode = number(primitive, "mode", kTriangles);
    if (++visits_ > kMostVisits) throw broken("has too many parts");
    if (mode < kTriangles || mode > kFan) return;  // points and lines
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end()) throw broken("lacks 'attributes'");
    const Accessor points = accessor(number(*attributes, "POSITION"), "VEC3");
    if (points.component != kFloat)
      throw broken("its positions are not float32: save it without quantization");
    check_count(mesh_.vertices.size() + points.count, 0, path_);
    const auto first = static_cast<int>(mesh_.vertices.size());
    for (std::size_t v = 0; v < points.count; ++v) {
      Eigen::Vector3f p;
      std::memcpy(p.data(), points.first + v * points.stride, sizeof(float) * 3);
      mesh_.vertices.emplace_back(place * p.cast<double>());
    }
    add_triangles(corners_of(primitive, points.count, mode), static_cast<int>(mode), first,
                  place.linear().determinant() < 0);
  }

  // A strip or a fan has nearly as many triangles as corners.
  void check_triangles(std::size_t corners, std::size_t mode) const {
    const std::size_t triangles = mode == kTriangles ? corners / 3 : std::max<std::size_t>(corners, 2) - 2;
    check_count(0, mesh_.triangles.size() + triangles, path_);
  }

  std::vector<int> corners_of(const Json& primitive, std::size_t points, std::size_t mode) const {
    std::vector<int> corners;
    if (!primitive.contains("indices")) {
      check_triangles(points, mode);
      corners.resize(points);
      std::iota(corners.begin(), corners.end(), 0);
      return corners;
    }
    const Accessor indices = accessor(number(primitive, "indices"), "SCALAR");
    const std::size_t size = indices.component == kByte ? 1 : indices.component == kShort ? 2 : 4;
    if (size == 4 && indices.component != kInt) throw broken("its indices are no whole numbers");
    check_triangles(indices.count, mode);
    corners.reserve(indices.count);
    for (std::size_t i = 0; i < indices.count; ++i) {
      std::uint32_t corner = 0;  // little-endian, as the format and this machine are
      std::memcpy(&corner, indices.first + i * indices.stride, size);
      if (corner >= points)
        throw Refusal(refusal::kBadMesh,
                      path_ + ": has a face with a vertex that is not there: " + std::to_string(corner));
      corners.push_back(static_cast<int>(corner));
    }
    return corners;
  }

  void add_triangles(const std::vector<int>& corners, int mode, int first, bool mirrored) {
    const std::size_t step = mode == kTriangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      Eigen::Vector3i t(corners[mode == kFan ? 0 : i], corners[i + 1], corners[i + 2]);
      if (mirrored != (mode == kStrip && i % 2 == 1)) std::swap(t[1], t[2]);
      mesh_.triangles.emplace_back(t.array() + first);
    }
  }

  static constexpr int kMostVisits = 100'000;
  const std::string& path_;
  Json root_;
  std::vector<std::unique_ptr<std::string>> decoded_;
  std::vector<std::string_view> buffers_;
  geometry::TriangleMesh mesh_;
  std::map<std::size_t, Eigen::Affine3d> bound_, worlds_;  // by skin; by node
  std::vector<std::size_t> parents_;                       // of nodes, as many as there are nodes: none
  int visits_ = 0;
};

geometry::TriangleMesh mesh_of(std::string_view text, std::string_view chunk, const std::string& path) {
  try {
    return Reader(text, chunk, path).mesh();
  } catch (const Json::exception&) {
    throw Refusal(refusal::kBrokenFile, path + ": its JSON is not glTF");
  }
}

}  // namespace

geometry::TriangleMesh gltf_mesh(const std::string& bytes, const std::string& path) {
  return mesh_of(bytes, {}, path);
}

geometry::TriangleMesh glb_mesh(const std::string& bytes, const std::string& path) {
  const auto broken = [&](const char* what) { return Refusal(refusal::kBrokenFile, path + ": " + what); };
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return static_cast<std::size_t>(value);
  };
  if (bytes.size() < 20 || bytes.compare(0, 4, "glTF") != 0) throw broken("is not GLB");
  if (number(4) != 2) throw broken("is GLB of another version than 2");
  if (number(8) != bytes.size()) throw broken("this GLB has another length than it says");
  const std::size_t text = number(12);
  if (bytes.compare(16, 4, "JSON") != 0 || text > bytes.size() - 20)
    throw broken("the first part of this GLB has another length or kind than it says");
  const std::string_view all(bytes);
  std::string_view chunk;
  if (const std::size_t next = 20 + text; bytes.size() >= next + 8) {
    if (number(next) > bytes.size() - next - 8)
      throw broken("the second part of this GLB is shorter than it says");
    chunk = all.substr(next + 8, number(next));
  }
  return mesh_of(all.substr(20, text), chunk, path);
}

}  // namespace tensegric_fit::mesh_files
