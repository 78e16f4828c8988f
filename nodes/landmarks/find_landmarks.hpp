/// Body mesh -> landmarks, heights, girths (ISO 8559-1 names; DESIGN §2 and §6).
#pragma once

#include <vector>

#include "geometry/body_measures.hpp"
#include "geometry/triangle_mesh.hpp"

namespace tensegric_fit::landmarks {

/// Field defaults are the parameters' defaults.
struct Options {};

/// `filled` is empty or has one flag a vertex: 1 where the scan saw nothing; landmarks there are less
/// certain. \throw Refusal not_a_body, wrong_unit, missing_part:<part>
geometry::BodyMeasures find_landmarks(const geometry::TriangleMesh& body, const std::vector<char>& filled,
                                      const Options& options);

}  // namespace tensegric_fit::landmarks
