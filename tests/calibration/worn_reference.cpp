#include "calibration/worn_reference.hpp"

#include <fmt/format.h>

#include <utility>

#include "correlation/correlate.hpp"
#include "geometry/status.hpp"

namespace tensegric_fit::calibration {
namespace {

using correlation::SkinPart;

constexpr std::size_t kFewest = 100;

}  // namespace

WornReference::Worn::Worn(fit::Body worn)
    : body(std::move(worn)), surface(body.mesh.mesh, body.mesh.filled) {}

WornReference::WornReference(const fit::Body& bare, const geometry::ControlMesh& control, fit::Body worn,
                             double cloth)
    : worn_(std::make_shared<const Worn>(std::move(worn))),
      control_{control.outer, control.triangles},
      cloth_(cloth) {
  const geometry::TriangleMesh& mesh = bare.mesh.mesh;
  const fit::Body& second = worn_->body;
  correlation::Correlation found =
      correlation::correlate({mesh, mesh.vertices, control_, bare.measures, bare.mesh.filled},
                             {second.mesh.mesh, second.mesh.filled, second.measures}, {cloth_});
  bare_from_worn_ = found.alignment.patch_from_scan;
  parts_ = std::move(found.parts);
  for (std::size_t v = 0; v < parts_.size(); ++v) {
    if (parts_[v] == SkinPart::covered && found.map.compared[v] != 0)
      covered_.push_back(static_cast<int>(v));
    else
      parts_[v] = SkinPart::mobile;
  }
  if (covered_.size() < kFewest)
    throw geometry::Refusal(geometry::refusal::kTooFewData,
                            fmt::format("the worn scan shows {} vertices of the covered skin, and {} are the "
                                        "fewest that say anything",
                                        covered_.size(), kFewest));
}

std::vector<double> WornReference::distances(const fit::Body& bare,
                                             const std::vector<Eigen::Vector3d>& deformed) const {
  const correlation::DistanceMap map = distance_map({bare.mesh.mesh, deformed, control_, bare.measures},
                                                    parts_, worn_->surface, bare_from_worn_, cloth_);
  std::vector<double> distances;
  for (const int v : covered_) distances.push_back(map.distance[v]);
  return distances;
}

}  // namespace tensegric_fit::calibration
