#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "body_model/array_file.hpp"
#include "body_model/model.hpp"

namespace tensegric_fit::body_model {
namespace {

using Json = nlohmann::json;

constexpr char kModelMagic[] = "tensegric_fit body model 1";
constexpr double kRounding = 0.001;                          // that shares of a skin point are written with
constexpr double kLeastStature = 1, kGreatestStature = 2.5;  // m
constexpr double kByte = 255;  // weights are shares in 255ths (definition of the format: README.md)
constexpr int kMost = 255;     // bones, parts: a vertex names them by a byte, 255 is a part that nobody knows

bool is_index(double value, std::size_t size) {
  return value >= 0 && value < static_cast<double>(size);
}

/// Bones, groups, parts and bone points.
void take_header(const Json& header, const Check& check, Model& model) {
  model.stature = header.at("stature");
  check(model.stature > kLeastStature && model.stature < kGreatestStature, "stature is not in metres");
  for (const Json& bone : header.at("bones")) model.bones.push_back({bone.at("name"), bone.at("parent")});
  const int count = static_cast<int>(model.bones.size());
  check(count > 0 && count <= kMost, "number of bones");
  for (int b = 0; b < count; ++b)
    check(model.bones[b].parent >= (b == 0 ? -1 : 0) && model.bones[b].parent < b,
          "a bone's parent must stand before it");
  for (const Json& group : header.at("groups")) {
    const std::vector<double> spread = group.at("spread");
    check(spread.size() == 3 && *std::min_element(spread.begin(), spread.end()) > 0, "a group's spread");
    model.groups.push_back({group.at("name"), group.at("bones"), {spread[0], spread[1], spread[2]}});
    for (const auto& [bone, share] : model.groups.back().bones)
      check(bone > 0 && bone < count && share > 0 && share <= 1, "a group's bone");
  }
  model.parts = header.at("parts").get<std::vector<std::string>>();
  check(model.parts.size() <= kMost, "number of parts");
  for (const Json& point : header.at("skin_points"))
    model.skin_points.push_back({point.at("name"), point.at("vertices")});
  for (const Json& point : header.at("bone_points")) {
    model.bone_points.push_back({point.at("name"), point.at("bone")});
    check(model.bone_points.back().bone >= 0 && model.bone_points.back().bone < count, "a bone point's bone");
  }
}

/// Skin at rest, and the bones that carry it.
void take_skin(const ArrayFile& file, const Check& check, Model& model) {
  model.mean = points(file.numbers("mean", {0, 3}));
  const std::size_t count = model.mean.size();
  const std::vector<double> step = file.numbers("step", {0}),
                            basis = file.numbers("basis", {step.size(), count, 3});
  model.basis.resize(static_cast<Eigen::Index>(step.size()), static_cast<Eigen::Index>(3 * count));
  for (std::size_t i = 0; i < 3 * count; ++i)
    for (std::size_t k = 0; k < step.size(); ++k)
      model.basis(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          static_cast<float>(step[k] * basis[k * 3 * count + i]);
  const std::vector<double> carriers = file.numbers("bones", {count, Model::kWeights}),
                            weights = file.numbers("weights", {count, Model::kWeights});
  model.carriers.resize(count);
  model.weights.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < Model::kWeights; ++j) {
      const std::size_t at = i * Model::kWeights + j;
      check(is_index(carriers[at], model.bones.size()), "a vertex' bone");
      model.carriers[i][j] = static_cast<unsigned char>(carriers[at]);
      model.weights[i][j] = static_cast<float>(weights[at] / kByte);
      sum += weights[at];
    }
    check(sum == kByte, "weights of a vertex that do not sum to 1");
  }
  const std::vector<double> quads = file.numbers("quads", {0, 4});
  for (const double corner : quads) check(is_index(corner, count), "a quad's vertex");
  for (std::size_t q = 0; q < quads.size(); q += 4) {
    const Eigen::Vector4i k = Eigen::Map<const Eigen::Vector4d>(&quads[q]).cast<int>();
    model.quads.push_back({k[0], k[1], k[2], k[3]});
    model.triangles.emplace_back(k[0], k[1], k[2]);
    model.triangles.emplace_back(k[0], k[2], k[3]);
  }
}

void take_arrays(const ArrayFile& file, const Check& check, Model& model) {
  take_skin(file, check, model);
  const std::size_t vertices = model.mean.size(), components = static_cast<std::size_t>(model.components());
  const std::size_t inner = model.bones.size() + model.bone_points.size();
  model.inner_mean = points(file.numbers("extra_mean", {inner, 3}));
  const std::vector<double> inner_basis = file.numbers("extra_basis", {components, inner, 3});
  model.inner_basis =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          inner_basis.data(), static_cast<Eigen::Index>(components), static_cast<Eigen::Index>(3 * inner));

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
  for (const double p : file.numbers("parts", {vertices})) {
    check(is_index(p, model.parts.size()), "a vertex' part");
    model.part.push_back(static_cast<unsigned char>(p));
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
  std::vector<char> on_quad(vertices, 0);  // each fit point stands for the skin round it
  for (const Eigen::Vector3i& t : model.triangles)
    for (const int v : t) on_quad[v] = 1;
  for (const double v : file.numbers("fit_points", {0})) {
    check(is_index(v, vertices) && on_quad[static_cast<std::size_t>(v)], "a fit point of no quad, or twice");
    model.fit_points.push_back(static_cast<int>(v));
    on_quad[model.fit_points.back()] = 0;
  }
  model.fit_weights = file.numbers("fit_weights", {model.fit_points.size()});
  check(*std::min_element(model.fit_weights.begin(), model.fit_weights.end()) >= 0, "a fit point's weight");
}

/// What other code asks for by name: a file without it would fail with the first customer.
void check_names(const Model& model, const Check& check) {
  const auto has = [](const auto& list, const std::string& name) {
    return std::any_of(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; });
  };
  const auto needed = [&](const std::string& what, std::initializer_list<const char*> names,
                          const auto& is_there) {
    for (const char* name : names) check(is_there(name), what + " '" + name + "' is missing");
  };
  const auto is_bone = [&](const std::string& name) { return has(model.bones, name); };
  const auto is_group = [&](const std::string& name) { return model.group_named(name) >= 0; };
  const auto is_part = [&](const std::string& name) { return model.part_named(name) >= 0; };
  const auto is_skin_point = [&](const std::string& name) { return has(model.skin_points, name); };
  const auto is_bone_point = [&](const std::string& name) { return has(model.bone_points, name); };
  needed("bone",
         {"upperarm01.L", "upperarm01.R", "lowerarm01.L", "lowerarm01.R", "upperleg01.L", "upperleg01.R",
          "lowerleg01.L", "lowerleg01.R", "foot.L", "foot.R"},
         is_bone);
  needed("group", {"arm_L", "arm_R", "forearm_L", "forearm_R"}, is_group);
  needed("part",
         {"head", "neck", "trunk", "breast_L", "breast_R", "upper_arm_L", "upper_arm_R", "forearm_L",
          "forearm_R", "hand_L", "hand_R", "thigh_L", "thigh_R", "shank_L", "shank_R", "foot_L", "foot_R"},
         is_part);
  needed("skin point",
         {"crotch", "navel", "neck_front", "neck_back", "neck_side_L", "neck_side_R", "neck_ring_front",
          "neck_ring_back", "neck_ring_L", "neck_ring_R", "bust_point_L", "bust_point_R", "underbust_L",
          "underbust_R"},
         is_skin_point);
  needed("bone point", {"acromion_L", "acromion_R"}, is_bone_point);
}

}  // namespace

int Model::part_named(const std::string& name) const {
  const auto found = std::find(parts.begin(), parts.end(), name);
  return found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
}

int Model::group_named(const std::string& name) const {
  const auto found =
      std::find_if(groups.begin(), groups.end(), [&](const PoseGroup& g) { return g.name == name; });
  return found == groups.end() ? -1 : static_cast<int>(found - groups.begin());
}

Model load_model(const std::string& path) {
  const Check check{path};
  const ArrayFile file(path, kModelMagic, "body model");
  Model model{};
  model.checksum = file.checksum();
  try {
    take_header(file.header(), check, model);
    take_arrays(file, check, model);
    check_names(model, check);
  } catch (const Json::exception& error) {
    check(false, error.what());
  }
  return model;
}

}  // namespace tensegric_fit::body_model
