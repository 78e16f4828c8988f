#include "ros/body_under_garment.hpp"

#include <algorithm>

#include "ros/body_messages.hpp"
#include "tensegric/band.hpp"
#include "tffd/body_volume.hpp"

namespace tensegric_fit::node {
namespace {

bool same(const tffd::LineOnBody& a, const tffd::LineOnBody& b) {
  return a.points == b.points && a.width == b.width && a.smooth == b.smooth && a.taut == b.taut &&
         a.held == b.held;
}

}  // namespace

std::vector<geometry::LaidLine> BodyUnderGarment::lay(const tensegric::Garment& garment) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<geometry::LaidLine> laid;
  std::vector<Line> lines;
  for (const tensegric::GarmentLine& line : garment.lines) {
    if (!line.on_body()) continue;
    const tensegric::Course course = tensegric::course_of(control_, line);
    const tffd::LineOnBody on_body{course.points, line.width, line.smooth, line.taut, course.held};
    const auto known = std::find_if(lines_.begin(), lines_.end(),
                                    [&on_body](const Line& one) { return same(one.on_body, on_body); });
    lines.push_back(known != lines_.end()
                        ? *known
                        : Line{on_body, tffd::lay_line(on_body, bound().mesh, bound().binding)});
    laid.push_back({line.name, lines.back().fibres});
  }
  lines_ = std::move(lines);
  return laid;
}

std::vector<tensegric::VolumeFunction> BodyUnderGarment::volumes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto carried = tffd::carried_triangles(bound().binding, bound().mesh.triangles, control_);
  std::vector<tensegric::VolumeFunction> volumes;
  for (std::size_t r = 0; r < carried.size(); ++r)
    volumes.push_back(
        tffd::BodyVolume(bound().binding, carried[r], geometry::region_apex(control_, control_.regions[r])));
  return volumes;
}

const BodyUnderGarment::Bound& BodyUnderGarment::bound() const {
  if (bound_) return *bound_;
  geometry::TriangleMesh mesh = mesh_in(*body_);
  tffd::Binding binding = tffd::Binding(mesh, control_, {}).posed(bones_);
  bound_ = std::make_unique<const Bound>(Bound{std::move(mesh), std::move(binding)});
  return *bound_;
}

}  // namespace tensegric_fit::node
