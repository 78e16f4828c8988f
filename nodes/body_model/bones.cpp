#include "body_model/bones.hpp"

#include <algorithm>
#include <cmath>

#include "body_model/registration.hpp"
#include "geometry/array_file.hpp"
#include "geometry/shipped_files.hpp"

namespace tensegric_fit::body_model {
namespace {

using Eigen::Vector3d;

using Json = nlohmann::json;

constexpr char kBonesMagic[] = "tensegric_fit bones 1";
constexpr double kMostlyArm = 0.5;  // definition: an arm carries more than half of a vertex
constexpr double
    kLeastStep = 0.0005,
    kMostPressed =
        0.15;  // m; tolerance of the last step, a tenth of kThinnestTissue; in all: half the depth of a trunk

/// The skin of the trunk: arms may lie against it.
geometry::TriangleMesh trunk_of(const RegisteredBody& body) {
  const Model& model = *body.model;
  std::vector<char> keep;
  for (const Eigen::Vector3i& t : model.triangles)
    keep.push_back(model.arm[t[0]] < kMostlyArm && model.arm[t[1]] < kMostlyArm &&
                   model.arm[t[2]] < kMostlyArm);
  return geometry::submesh({body.skin, model.triangles}, keep);
}

/// Presses points below the skin.
class Skin {
 public:
  explicit Skin(const RegisteredBody& body)
      : mesh_(trunk_of(body)),
        normals_(geometry::vertex_normals(mesh_.vertices, mesh_.triangles)),
        tree_(mesh_) {}

  /// Moves a point nearer to the skin than kThinnestTissue, or outside, along `inward` until it is not.
  Vector3d below(Vector3d point, const Vector3d& inward) const {
    const Vector3d start = point;
    for (double lack = lacking(point); lack > 0 && (point - start).norm() < kMostPressed;
         lack = lacking(point))
      point += std::max(lack, kLeastStep) * inward;
    return point;
  }

 private:
  /// How much deeper below the skin a point must go, m.
  double lacking(const Vector3d& point) const {
    const geometry::SurfacePoint foot = tree_.nearest(point);
    const Eigen::Vector3i& k = mesh_.triangles[foot.triangle];
    Vector3d normal = Vector3d::Zero();
    for (int c = 0; c < 3; ++c) normal += foot.barycentric[c] * normals_[k[c]];
    const Vector3d in = foot.position - point;
    return kThinnestTissue - (in.dot(normal) > 0 ? in.norm() : -in.norm());
  }

  geometry::TriangleMesh mesh_;
  std::vector<Vector3d> normals_;
  geometry::SurfaceTree tree_;
};

}  // namespace

std::vector<BoneShape> load_bones(const std::string& path, const Model& model) {
  const geometry::Check check{path};
  const geometry::ArrayFile file(path, kBonesMagic, "file of bones");
  std::vector<BoneShape> shapes;
  try {
    const std::string made_for = file.header().at("model");
    if (made_for != model.checksum)
      throw geometry::Refusal(geometry::refusal::kOtherModel, path + ": made for body model '" + made_for +
                                                                  "', not for '" + model.checksum +
                                                                  "': run tests/body_model/bones.py anew");
    for (const Json& bone : file.header().at("bones")) {
      const std::string name = bone.at("name");
      shapes.push_back({skinned_in(file, name + "_", model.bones.size(), check), name});
      const BoneShape& shape = shapes.back();
      check(shape.basis.rows() == model.components(), "a bone of another number of components");
      std::vector<char> has_normal(shape.mean.size(), 0);  // it is pressed along it
      for (const Eigen::Vector3i& t : shape.triangles)
        for (const int v : t) has_normal[v] = 1;
      check(std::find(has_normal.begin(), has_normal.end(), 0) == has_normal.end(),
            "a bone's point of no quad");
    }
  } catch (const Json::exception& error) {
    check(false, error.what());
  }
  check(!shapes.empty(), "no bones");
  return shapes;
}

const std::vector<BoneShape>& shipped_bones() {
  static const std::vector<BoneShape> bones =
      load_bones(geometry::shipped_folder("body_model") + "/bones.tfb", shipped_registrar().model());
  return bones;
}

std::vector<BoneSurface> bones_of(const RegisteredBody& body, const std::vector<BoneShape>& shapes) {
  const PosedModel model(*body.model, body.parameters);
  const Skin skin(body);
  std::vector<BoneSurface> surfaces;
  for (const BoneShape& shape : shapes) {
    surfaces.push_back({shape.name, {model.carried(shape), shape.triangles}});
    geometry::TriangleMesh& mesh = surfaces.back().mesh;
    const std::vector<Vector3d> normals = geometry::vertex_normals(mesh.vertices, mesh.triangles);
    for (std::size_t i = 0; i < normals.size(); ++i)
      mesh.vertices[i] = skin.below(mesh.vertices[i], -normals[i]);
  }
  return surfaces;
}

Tissue::Tissue(const std::vector<BoneSurface>& bones) {
  for (const BoneSurface& bone : bones) trees_.emplace_back(bone.mesh);
}

Tissue::Depth Tissue::depth(const Vector3d& skin) const {
  Depth best{0, skin, -1};
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    const Vector3d foot = trees_[b].nearest(skin).position;
    const double distance = (foot - skin).norm();
    if (best.bone < 0 || distance < best.distance) best = {distance, foot, static_cast<int>(b)};
  }
  return best;
}

}  // namespace tensegric_fit::body_model
