#include "ros/body_under_garment.hpp"

#include "ros/body_messages.hpp"
#include "tffd/body_volume.hpp"
#include "tffd/lay_line.hpp"

namespace tensegric_fit::node {

std::vector<geometry::LaidLine> BodyUnderGarment::lay(const tensegric::Garment& garment) const {
  std::vector<geometry::LaidLine> laid;
  for (const tensegric::GarmentLine& line : garment.lines)
    if (!line.points.empty())
      laid.push_back({line.name, tffd::lay_line({line.points, line.width, line.smooth, line.taut},
                                                bound().mesh, bound().binding)});
  return laid;
}

std::vector<tensegric::VolumeFunction> BodyUnderGarment::volumes() const {
  const auto carried = tffd::carried_triangles(bound().binding, bound().mesh.triangles, control_);
  std::vector<tensegric::VolumeFunction> volumes;
  for (std::size_t r = 0; r < carried.size(); ++r)
    volumes.push_back(
        tffd::BodyVolume(bound().binding, carried[r], geometry::region_apex(control_, control_.regions[r])));
  return volumes;
}

const BodyUnderGarment::Bound& BodyUnderGarment::bound() const {
  std::call_once(once_, [this] {
    geometry::TriangleMesh mesh = mesh_in(*body_);
    tffd::Binding binding = tffd::Binding(mesh, control_, {}).posed(bones_);
    bound_ = std::make_unique<const Bound>(Bound{std::move(mesh), std::move(binding)});
  });
  return *bound_;
}

}  // namespace tensegric_fit::node
