/// A control mesh beside the body that it was laid on.
#pragma once

#include <string>
#include <vector>

#include "body_model/registered_body.hpp"
#include "control_mesh/template.hpp"
#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"
#include "scored_figures.hpp"

namespace tensegric_fit::population {

/// Lays the template on the body: how far nodes lie off the skin (3 mm), by how much its volume differs from
/// the body's under it (2 %), how far nodes that stand for landmarks are off them (2 mm: on noisy skin
/// landmarks lie up to that far off the mesh themselves). As drawn and with four times as many triangles: how
/// many are folded over against the skin of the trunk nearest to them (0 asked), what their least corner
/// lacks to 5 degrees and their least area to 2 % of the median one (0 asked), the largest sum of absolute
/// entries of a row of t-FFD's M (3). They do not count among a body's figures. One infinite error where the
/// template cannot be laid, for want of a landmark for instance.
std::vector<Figure> control_figures(const control_mesh::Template& pattern, const geometry::TriangleMesh& body,
                                    const geometry::BodyMeasures& measures,
                                    const body_model::RegisteredBody& model);

}  // namespace tensegric_fit::population
