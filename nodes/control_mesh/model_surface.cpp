#include "control_mesh/model_surface.hpp"

#include <algorithm>

#include "geometry/status.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::control_mesh {
namespace {

using Eigen::Vector3d;

/// The vertex across the mid-plane: the mean body is its own mirror image.
int mirrored(const body_model::Model& model, int vertex) {
  const Vector3d image = model.mean[vertex].cwiseProduct(Vector3d(-1, 1, 1));
  const auto nearest =
      std::min_element(model.mean.begin(), model.mean.end(), [&](const Vector3d& a, const Vector3d& b) {
        return (a - image).squaredNorm() < (b - image).squaredNorm();
      });
  return static_cast<int>(nearest - model.mean.begin());
}

}  // namespace

ModelSurface::ModelSurface(const body_model::RegisteredBody& model, const Eigen::Isometry3d& body_from_scan)
    : model_(model),
      body_from_scan_(body_from_scan),
      normals_(geometry::vertex_normals(model.skin, model.model->triangles)),
      tree_(model.skin, normals_) {}

std::vector<std::pair<int, double>> ModelSurface::vertices_of(const ModelPoint& point, Side side,
                                                              const std::string& where) const {
  const body_model::Model& model = *model_.model;
  if (point.name.empty()) {
    if (point.vertex >= static_cast<int>(model.mean.size()))
      throw geometry::Refusal(geometry::refusal::kBadTemplate,
                              where + ": the body model has no vertex " + std::to_string(point.vertex));
    return {{side == Side::left ? point.vertex : mirrored(model, point.vertex), 1}};
  }
  const std::string name = name_on(point.name, side);
  for (const body_model::SkinPoint& known : model.skin_points)
    if (known.name == name) return known.vertices;
  throw geometry::Refusal(geometry::refusal::kBadTemplate,
                          where + ": the body model has no skin point '" + name + "'");
}

ModelSurface::Place ModelSurface::place(const std::vector<ModelPoint>& points, Side side,
                                        const std::string& where) const {
  Place place{Vector3d::Zero(), Vector3d::Zero()};
  for (const ModelPoint& point : points)
    for (const auto& [vertex, share] : vertices_of(point, side, where)) {
      place.point += point.share * share * model_.skin[vertex];
      place.normal += point.share * share * normals_[vertex];
    }
  place.point = body_from_scan_ * place.point;
  place.normal = (body_from_scan_.linear() * place.normal).normalized();
  return place;
}

void ModelSurface::check(const std::vector<ModelPoint>& points, const std::string& where) const {
  for (const ModelPoint& point : points) {
    vertices_of(point, Side::left, where);
    if (!point.name.empty()) vertices_of(point, Side::right, where);  // a vertex has its mirror image
  }
}

bool ModelSurface::on_breast(const Vector3d& point, const Vector3d& normal) const {
  const Eigen::Isometry3d scan_from_body = body_from_scan_.inverse();
  const int vertex = tree_.nearest(scan_from_body * point, scan_from_body.linear() * normal);
  return model_.model->parts[model_.model->part[vertex]].rfind("breast", 0) == 0;
}

}  // namespace tensegric_fit::control_mesh
