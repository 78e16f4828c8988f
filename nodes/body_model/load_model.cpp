#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "body_model/model.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::body_model {
namespace {

using Json = nlohmann::json;

constexpr char kMagic[] = "tensegric_fit body model 1";
constexpr std::size_t kLongestHeader = 1 << 20;  // bytes
constexpr std::size_t kLargestArray = 1 << 26;   // bytes
constexpr double kRounding = 0.001;              // that shares of a skin point are written with
constexpr double kShortest = 1, kTallest = 2.5;  // m

/// Refuses the file with `what`.
struct Check {
  const std::string& path;
  void operator()(bool holds, const std::string& what) const {
    if (!holds) throw geometry::Refusal(geometry::refusal::kBrokenFile, path + ": " + what);
  }
};

struct Array {
  std::string type;
  std::vector<std::size_t> shape;
  std::string bytes;
};

const std::map<std::string, std::size_t> kSizes = {
    {"float32", 4}, {"int16", 2}, {"uint16", 2}, {"int8", 1}, {"uint8", 1}};

/// Numbers of an array as doubles. Files are little-endian, as every machine is that the product runs on.
std::vector<double> numbers(const Array& array) {
  std::vector<double> result;
  const auto take = [&](auto zero) {
    using Type = decltype(zero);
    const auto* data = reinterpret_cast<const Type*>(array.bytes.data());
    result.assign(data, data + array.bytes.size() / sizeof(Type));
  };
  if (array.type == "float32") take(0.0F);
  if (array.type == "int16") take(std::int16_t{});
  if (array.type == "uint16") take(std::uint16_t{});
  if (array.type == "int8") take(std::int8_t{});
  if (array.type == "uint8") take(std::uint8_t{});
  return result;
}

std::vector<Eigen::Vector3d> points(const std::vector<double>& xyz) {
  std::vector<Eigen::Vector3d> result(xyz.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  return result;
}

std::map<std::string, Array> read_arrays(std::istream& file, const Json& list, const Check& check) {
  std::map<std::string, Array> arrays;
  for (const Json& entry : list) {
    Array array{entry.at("type"), entry.at("shape"), {}};
    check(kSizes.count(array.type) > 0, "array of an unknown type");
    std::size_t bytes = kSizes.at(array.type);
    for (const std::size_t extent : array.shape) {
      check(extent <= kLargestArray && bytes * extent <= kLargestArray, "an array is too large");
      bytes *= extent;
    }
    array.bytes.resize(bytes);
    file.read(array.bytes.data(), static_cast<std::streamsize>(bytes));
    check(static_cast<std::size_t>(file.gcount()) == bytes, "truncated");
    arrays[entry.at("name")] = std::move(array);
  }
  check(file.peek() == std::char_traits<char>::eof(), "bytes after the last array");
  return arrays;
}

/// Bones, groups, parts and bone points.
void take_header(const Json& header, const Check& check, Model& model) {
  model.stature = header.at("stature");
  check(model.stature > kShortest && model.stature < kTallest, "stature is not in metres");
  for (const Json& bone : header.at("bones")) model.bones.push_back({bone.at("name"), bone.at("parent")});
  const int count = static_cast<int>(model.bones.size());
  check(count > 0, "no bones");
  for (int b = 0; b < count; ++b)
    check(model.bones[b].parent >= (b == 0 ? -1 : 0) && model.bones[b].parent < b, "a bone's parent must stand before it");
  for (const Json& group : header.at("groups")) {
    const std::vector<double> spread = group.at("spread");
    check(spread.size() == 3 && *std::min_element(spread.begin(), spread.end()) > 0, "a group's spread");
    model.groups.push_back({group.at("name"), group.at("bones"), {spread[0], spread[1], spread[2]}});
    for (const auto& [bone, share] : model.groups.back().bones)
      check(bone > 0 && bone < count && share > 0 && share <= 1, "a group's bone");
  }
  model.parts = header.at("parts").get<std::vector<std::string>>();
  for (const Json& point : header.at("skin_points"))
    model.skin_points.push_back({point.at("name"), point.at("vertices")});
  for (const Json& point : header.at("bone_points")) {
    model.bone_points.push_back({point.at("name"), point.at("bone")});
    check(model.bone_points.back().bone >= 0 && model.bone_points.back().bone < count, "a bone point's bone");
  }
}

/// Of all bytes of the file, which is read to its end.
std::string checksum_of(std::istream& file) {
  std::uint64_t value = 14695981039346656037u;
  std::vector<char> bytes(1 << 16);
  while (file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) || file.gcount() > 0)
    for (std::streamsize i = 0; i < file.gcount(); ++i)
      value = (value ^ static_cast<unsigned char>(bytes[i])) * 1099511628211u;
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << value;
  return text.str();
}

void take_arrays(const std::map<std::string, Array>& arrays, const Check& check, Model& model) {
  const auto array = [&](const std::string& name, std::vector<std::size_t> shape) {
    check(arrays.count(name) > 0, "no array '" + name + "'");
    const Array& found = arrays.at(name);
    check(found.shape.size() == shape.size(), "shape of '" + name + "'");
    for (std::size_t i = 0; i < shape.size(); ++i)
      check(shape[i] == 0 || found.shape[i] == shape[i], "shape of '" + name + "'");
    const std::vector<double> values = numbers(found);
    check(!values.empty() && std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }),
          "'" + name + "' is empty or not finite");
    return values;
  };
  model.mean = points(array("mean", {0, 3}));
  const std::size_t vertices = model.mean.size();
  const std::vector<double> step = array("step", {0});
  const std::size_t components = step.size();
  const std::vector<double> basis = array("basis", {components, vertices, 3});
  model.basis.resize(static_cast<Eigen::Index>(components), static_cast<Eigen::Index>(3 * vertices));
  for (std::size_t k = 0; k < components; ++k)
    for (std::size_t i = 0; i < 3 * vertices; ++i)
      model.basis(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = static_cast<float>(step[k] * basis[k * 3 * vertices + i]);

  const std::size_t inner = model.bones.size() + model.bone_points.size();
  model.inner_mean = points(array("extra_mean", {inner, 3}));
  const std::vector<double> inner_basis = array("extra_basis", {components, inner, 3});
  model.inner_basis = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      inner_basis.data(), static_cast<Eigen::Index>(components), static_cast<Eigen::Index>(3 * inner));

  const auto is_index = [](double value, std::size_t size) { return value >= 0 && value < static_cast<double>(size); };
  const std::vector<double> bones = array("bones", {vertices, Model::kWeights}), weights = array("weights", {vertices, Model::kWeights});
  model.carriers.resize(vertices);
  model.weights.resize(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    for (int j = 0; j < Model::kWeights; ++j) {
      const std::size_t at = v * Model::kWeights + j;
      check(is_index(bones[at], model.bones.size()), "a vertex' bone");
      model.carriers[v][j] = static_cast<unsigned char>(bones[at]);
      model.weights[v][j] = static_cast<float>(weights[at] / 255);
    }
  }
  const auto is_arm = [&](int bone) {
    const std::string& name = model.bones[bone].name;
    return name.rfind("upperarm", 0) == 0 || name.rfind("lowerarm", 0) == 0 || name.rfind("wrist", 0) == 0;
  };
  for (std::size_t v = 0; v < vertices; ++v) {
    double arm = 0;
    for (int j = 0; j < Model::kWeights; ++j)
      if (is_arm(model.carriers[v][j])) arm += model.weights[v][j];
    model.arm.push_back(arm);
  }
  for (const double p : array("parts", {vertices})) {
    check(is_index(p, model.parts.size()), "a vertex' part");
    model.part.push_back(static_cast<unsigned char>(p));
  }
  const std::vector<double> quads = array("quads", {0, 4});
  for (std::size_t q = 0; q < quads.size(); q += 4) {
    std::array<int, 4> quad;
    for (int c = 0; c < 4; ++c) {
      check(is_index(quads[q + c], vertices), "a quad's vertex");
      quad[c] = static_cast<int>(quads[q + c]);
    }
    model.quads.push_back(quad);
    model.triangles.emplace_back(quad[0], quad[1], quad[2]);
    model.triangles.emplace_back(quad[0], quad[2], quad[3]);
  }
  for (SkinPoint& point : model.skin_points) {
    double sum = 0;
    for (const auto& [vertex, share] : point.vertices) {
      check(vertex >= 0 && vertex < static_cast<int>(vertices) && share > 0, "a skin point's vertex");
      sum += share;
    }
    check(std::abs(sum - 1) < kRounding, "a skin point's shares");
    for (auto& share : point.vertices) share.second /= sum;
  }
  for (const double v : array("fit_points", {0})) {
    check(is_index(v, vertices), "a fit point");
    model.fit_points.push_back(static_cast<int>(v));
  }
  model.fit_weights = array("fit_weights", {model.fit_points.size()});
}

}  // namespace

int Model::part_named(const std::string& name) const {
  const auto found = std::find(parts.begin(), parts.end(), name);
  return found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
}

int Model::group_named(const std::string& name) const {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const PoseGroup& g) { return g.name == name; });
  return found == groups.end() ? -1 : static_cast<int>(found - groups.begin());
}

Model load_model(const std::string& path) {
  const Check check{path};
  std::ifstream file(path, std::ios::binary);
  check(file.good(), "cannot be read");
  const std::string checksum = checksum_of(file);
  file.clear();
  file.seekg(0);
  std::string magic, length;
  std::getline(file, magic);
  check(magic == kMagic, "not a body model of this format");
  std::getline(file, length);
  check(!length.empty() && length.size() < 8 && length.find_first_not_of("0123456789") == std::string::npos &&
            std::stoul(length) <= kLongestHeader,
        "length of the header");
  std::string text(std::stoul(length), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  Model model{};
  model.checksum = checksum;
  try {
    const Json header = Json::parse(text);
    take_header(header, check, model);
    take_arrays(read_arrays(file, header.at("arrays"), check), check, model);
  } catch (const Json::exception& error) {
    check(false, error.what());
  }
  return model;
}

}  // namespace tensegric_fit::body_model
