#include "inspect/body_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/status.hpp"

namespace tensegric_fit::inspect {

using geometry::Refusal;

void BodyView::take_body(const std::string& scan_id, geometry::TriangleMesh mesh) {
  geometry::check_mesh(mesh);
  if (mesh.triangles.empty()) throw Refusal(geometry::refusal::kBadMesh, "the body mesh has no triangles");
  stretch_.emplace(mesh);
  mesh_ = std::move(mesh);
  ++revision_;
  if (scan_id == scan_id_ && !waiting_) waiting_ = std::move(worn_);
  scan_id_ = scan_id;
  worn_.reset();
  note_.clear();
  if (!waiting_) return;
  try {
    take_worn(*std::exchange(waiting_, std::nullopt));
  } catch (const Refusal& refusal) {
    note_ = refusal.what();
  }
}

void BodyView::take_worn(Worn worn) {
  if (worn.scan_id != scan_id_) {
    note_ = fmt::format("the deformed body of scan {} waits for its mesh", worn.scan_id);
    waiting_ = std::move(worn);
    return;
  }
  check(worn);
  worn_ = std::move(worn);
  waiting_.reset();
  note_.clear();
}

bool BodyView::forget(const std::string& scan_id) {
  const bool waits = waiting_ && waiting_->scan_id == scan_id, is_shown = !empty() && scan_id_ == scan_id;
  if (waits) {
    waiting_.reset();
    note_.clear();
  }
  if (!is_shown) return waits;
  scan_id_.clear();
  mesh_ = {};
  ++revision_;
  stretch_.reset();
  worn_.reset();
  return true;
}

void BodyView::check(const Worn& worn) const {
  const std::size_t count = mesh_.vertices.size();
  if (worn.vertices.size() != count || worn.distortion.size() != count)
    throw Refusal(geometry::refusal::kBadMesh,
                  fmt::format("the deformed body has {} vertices and {} values of distortion, its mesh {}",
                              worn.vertices.size(), worn.distortion.size(), count));
  const auto finite = [](const auto& vertex) { return vertex.allFinite(); };
  if (!std::all_of(worn.vertices.begin(), worn.vertices.end(), finite) ||
      !std::all_of(worn.distortion.begin(), worn.distortion.end(), [](double d) { return std::isfinite(d); }))
    throw Refusal(geometry::refusal::kNonFinite,
                  "the deformed body has positions or distortions that are no numbers");
}

std::vector<Eigen::Vector3d> BodyView::vertices(double blend) const {
  if (!worn_ || blend == 0) return mesh_.vertices;
  if (blend == 1) return worn_->vertices;
  std::vector<Eigen::Vector3d> between(mesh_.vertices.size());
  for (std::size_t v = 0; v < between.size(); ++v)
    between[v] = mesh_.vertices[v] + blend * (worn_->vertices[v] - mesh_.vertices[v]);
  return between;
}

std::vector<double> BodyView::values(ColourBy by, double blend) const {
  const double neutral = fixed_scale(by).neutral;
  if (!worn_ || by == ColourBy::plain) return std::vector<double>(mesh_.vertices.size(), neutral);
  std::vector<double> values;
  if (by == ColourBy::distortion) {
    values = worn_->distortion;
  } else if (by == ColourBy::stretch) {
    values = stretch_->at(worn_->vertices);
  } else {
    values.resize(mesh_.vertices.size());
    for (std::size_t v = 0; v < values.size(); ++v)
      values[v] = (worn_->vertices[v] - mesh_.vertices[v]).norm();
  }
  for (double& value : values) value = neutral + blend * (value - neutral);
  return values;
}

}  // namespace tensegric_fit::inspect
