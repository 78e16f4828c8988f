#include <algorithm>
#include <cmath>

#include "body_model/array_file.hpp"
#include "body_model/model.hpp"

namespace tensegric_fit::body_model {
namespace {

constexpr char kModelMagic[] = "tensegric_fit body model 1";
constexpr double kRounding = 0.001;                          // that shares of a skin point are written with
constexpr double kLeastStature = 1, kGreatestStature = 2.5;  // m

/// Bones, groups, parts and bone points.
void take_header(const Json& header, const Check& check, Model& model) {
  model.stature = header.at("stature");
  check(model.stature > kLeastStature && model.stature < kGreatestStature, "stature is not in metres");
  for (const Json& bone : header.at("bones")) model.bones.push_back({bone.at("name"), bone.at("parent")});
  const int count = static_cast<int>(model.bones.size());
  check(count > 0, "no bones");
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
  for (const Json& point : header.at("skin_points"))
    model.skin_points.push_back({point.at("name"), point.at("vertices")});
  for (const Json& point : header.at("bone_points")) {
    model.bone_points.push_back({point.at("name"), point.at("bone")});
    check(model.bone_points.back().bone >= 0 && model.bone_points.back().bone < count, "a bone point's bone");
  }
}

void take_arrays(const ArrayFile& file, const Check& check, Model& model) {
  const auto array = [&](const std::string& name, const std::vector<std::size_t>& shape) {
    return file.numbers(name, shape);
  };
  model.mean = points(array("mean", {0, 3}));
  const std::size_t vertices = model.mean.size();
  const std::vector<double> step = array("step", {0});
  const std::size_t components = step.size();
  const std::vector<double> basis = array("basis", {components, vertices, 3});
  model.basis.resize(static_cast<Eigen::Index>(components), static_cast<Eigen::Index>(3 * vertices));
  for (std::size_t i = 0; i < 3 * vertices; ++i)
    for (std::size_t k = 0; k < components; ++k)
      model.basis(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          static_cast<float>(step[k] * basis[k * 3 * vertices + i]);

  const std::size_t inner = model.bones.size() + model.bone_points.size();
  model.inner_mean = points(array("extra_mean", {inner, 3}));
  const std::vector<double> inner_basis = array("extra_basis", {components, inner, 3});
  model.inner_basis =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          inner_basis.data(), static_cast<Eigen::Index>(components), static_cast<Eigen::Index>(3 * inner));

  const auto is_index = [](double value, std::size_t size) {
    return value >= 0 && value < static_cast<double>(size);
  };
  const std::vector<double> bones = array("bones", {vertices, Model::kWeights}),
                            weights = array("weights", {vertices, Model::kWeights});
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
  } catch (const Json::exception& error) {
    check(false, error.what());
  }
  return model;
}

}  // namespace tensegric_fit::body_model
